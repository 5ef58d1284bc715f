# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""OpenCV, Pillow and NumPy read the same values from our files, and we from theirs."""

import itertools
import os

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"  # must be set before cv2 is loaded

import numpy as np
import pytest

import tofsmith as ts

cv2 = pytest.importorskip("cv2")
pillow = pytest.importorskip("PIL.Image")

RANDOM = np.random.default_rng(7)
REC709 = np.array([0.2126, 0.7152, 0.0722])


def albedo_of(tmp_path, image):
    """Returns the values of an image, 0 to 1, as the albedo of a plane."""
    height, width = cv2.imread(str(image), cv2.IMREAD_UNCHANGED).shape[:2]
    np.save(tmp_path / "depth.npy", np.ones((height, width), np.float32))
    return ts.load_scene(tmp_path / "depth.npy", image=image, linear_image=True).albedo


def luminance(rgb, full):
    """Returns the luminance of grey or RGB values; alpha is ignored."""
    share = np.asarray(rgb, np.float64) / full
    return share if share.ndim == 2 else share[..., :3] @ REC709


def expect_albedo(tmp_path, rgb, full):
    """Compares the albedo read from a.png with the luminance of grey or RGB values."""
    np.testing.assert_allclose(albedo_of(tmp_path, tmp_path / "a.png"), luminance(rgb, full),
                               atol=2e-7)


@pytest.mark.parametrize("mode, channels", [("1", 0), ("L", 0), ("LA", 2), ("RGB", 3), ("RGBA", 4)])
def test_8_bit_png_equals_pillow(tmp_path, mode, channels):
    values = RANDOM.integers(0, 256, (5, 7, channels) if channels else (5, 7), np.uint8)
    image = pillow.fromarray(values) if mode != "1" else pillow.fromarray(values > 127)
    image.save(tmp_path / "a.png")
    again = pillow.open(tmp_path / "a.png")
    assert again.mode == mode
    expect_albedo(tmp_path, again.convert("L" if channels < 3 else "RGB"), 255)


@pytest.mark.parametrize("colours, transparent", [(2, None), (16, None), (256, 3)])
def test_png_with_a_palette_equals_pillow(tmp_path, colours, transparent):
    image = pillow.fromarray(RANDOM.integers(0, colours, (5, 7), np.uint8), "P")
    image.putpalette(RANDOM.integers(0, 256, 3 * colours, np.uint8).tobytes())
    options = {} if transparent is None else {"transparency": transparent}
    image.save(tmp_path / "a.png", **options)
    expect_albedo(tmp_path, pillow.open(tmp_path / "a.png").convert("RGB"), 255)


@pytest.mark.parametrize("channels", [1, 3, 4])
def test_16_bit_png_equals_opencv(tmp_path, channels):
    values = RANDOM.integers(0, 65536, (5, 7, channels), np.uint16).squeeze()
    assert cv2.imwrite(str(tmp_path / "a.png"), values)
    expect_albedo(tmp_path, values if channels == 1 else values[..., 2::-1], 65535)


def test_depth_in_png_is_exchanged_with_opencv(tmp_path):
    values = RANDOM.integers(1, 65536, (5, 7), np.uint16)
    assert cv2.imwrite(str(tmp_path / "a.png"), values)
    depth = ts.read_depth(tmp_path / "a.png")
    np.testing.assert_array_equal(depth, (values / 1000).astype(np.float32))
    ts.write_depth(tmp_path / "b.png", depth)
    np.testing.assert_array_equal(cv2.imread(str(tmp_path / "b.png"), cv2.IMREAD_UNCHANGED), values)


def test_opencv_reads_our_floats(tmp_path):
    depth = RANDOM.normal(3, 1, (5, 7)).astype(np.float32)
    for name in ("a.pfm", "a.exr"):
        ts.write_depth(tmp_path / name, depth)
    content = (tmp_path / "a.exr").read_bytes()
    at = content.index(b"chlist\0") + 11
    assert content[at:at + 2] == b"Z\0"  # Z for distance; OpenCV supports Y and colours only
    (tmp_path / "a.exr").write_bytes(content[:at] + b"Y" + content[at + 1:])
    for name in ("a.pfm", "a.exr"):
        found = cv2.imread(str(tmp_path / name), cv2.IMREAD_UNCHANGED)
        np.testing.assert_array_equal(found, depth)


@pytest.mark.parametrize("kind, compression", itertools.product(
    ["half", "float"], ["no", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"]))
def test_exr_of_every_kind_equals_opencv(tmp_path, kind, compression):
    values = RANDOM.uniform(0.1, 1, (37, 41)).astype(np.float32)
    path = str(tmp_path / "a.exr")
    assert cv2.imwrite(path, values, [
        cv2.IMWRITE_EXR_TYPE, getattr(cv2, f"IMWRITE_EXR_TYPE_{kind.upper()}"),
        cv2.IMWRITE_EXR_COMPRESSION, getattr(cv2, f"IMWRITE_EXR_COMPRESSION_{compression.upper()}")])
    expected = cv2.imread(path, cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(ts.read_depth(path), expected)
    np.testing.assert_allclose(expected, values, rtol=0.1)
    colours = RANDOM.uniform(0, 1, (6, 5, 3)).astype(np.float32)
    assert cv2.imwrite(path, colours)
    np.testing.assert_allclose(albedo_of(tmp_path, path), luminance(colours[..., ::-1], 1),
                               rtol=1e-6)


def ply_of(vertices, triangles, count):
    """Returns the bytes of a mesh whose faces store their number of corners as type `count`."""
    names = {"u1": "uchar", "i4": "int", "u2": "ushort"}
    header = (f"ply\nformat binary_big_endian 1.0\nelement vertex {len(vertices)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\n"
              f"property list {names[count]} int vertex_indices\nend_header\n")
    faces = np.zeros(len(triangles), [("n", ">" + count), ("corners", ">i4", 3)])
    faces["n"], faces["corners"] = 3, triangles
    return header.encode() + vertices.astype(">f4").tobytes() + faces.tobytes()


def test_ply_faces_with_any_type_of_count_give_the_same_mesh(tmp_path):
    vertices = np.array([[-1, -1, 2], [1, -1, 2], [0, 1, 3], [0, 0, 1.5]])
    triangles = np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    seen = []
    for count in ("u1", "u2", "i4"):
        (tmp_path / "a.ply").write_bytes(ply_of(vertices, triangles, count))
        seen.append(ts.load_scene(tmp_path / "a.ply", width=16, height=12).depth_m)
    assert np.isfinite(seen[0]).any()
    for depth in seen[1:]:
        np.testing.assert_array_equal(depth, seen[0])


def by_pillow(**options):
    return lambda image, path: pillow.fromarray(image).save(path, **options)


def by_opencv(image, path):
    assert cv2.imwrite(str(path), image)


@pytest.mark.parametrize("extension, write", [
    (".tiff", by_pillow(compression=None)), (".tif", by_pillow(compression="tiff_lzw")),
    (".tiff", by_pillow(compression="tiff_adobe_deflate")),
    (".tiff", by_pillow(compression="packbits")), (".png", by_pillow()),
    (".tiff", by_opencv), (".png", by_opencv), (".pgm", by_opencv)])
def test_phase_images_decode_like_their_array(tmp_path, extension, write):
    raw = RANDOM.poisson(3000, (31, 53, 4)).astype(np.uint16)
    decoder = ts.Decoder("sinusoid-k4", ts.Camera("paper-10f0"))
    files = [tmp_path / f"p{k}{extension}" for k in range(4)]
    for k, path in enumerate(files):
        write(np.ascontiguousarray(raw[..., k]), path)
    decoder.decode_recording(files, tmp_path / "images.npy")
    np.save(tmp_path / "raw.npy", raw)
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "array.npy")
    assert (tmp_path / "images.npy").read_bytes() == (tmp_path / "array.npy").read_bytes()
