# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Lenses that distort: OpenCV's own numbers, and what is seen through them."""

import numpy as np
import pytest

import tofsmith as ts

PINHOLE = {"fx_px": 220.0, "fy_px": 222.0, "cx_px": 158.0, "cy_px": 121.5}
LENSES = [
    ("opencv", [-0.28, 0.07, 1e-3, -5e-4]),
    ("opencv", [0.12, -0.2, -1e-3, 2e-3, 0.05]),
    ("opencv", [0.42, -2.6, 6e-4, -2e-4, 1.5, 0.31, -2.4, 1.42]),
    ("opencv", [-0.1, 0.02, 0.0, 0.0, 0.0, 0.2, 0.01, 0.0, 3e-3, -1e-3, -2e-3, 5e-4]),
    ("fisheye", [0.05, -0.02, 0.01, -0.003]),
]


def lens_of(model, coefficients):
    return ts.Lens(**PINHOLE, distortion_model=model, distortion=tuple(coefficients))


@pytest.mark.parametrize("model, coefficients", LENSES)
def test_opencv_images_the_ray_of_a_pixel_at_that_pixel(model, coefficients):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, the oracle, is missing (python3-opencv)")
    points = ts.points_m(np.ones((240, 320)), lens_of(model, coefficients))
    matrix = np.array([[PINHOLE["fx_px"], 0, PINHOLE["cx_px"]],
                       [0, PINHOLE["fy_px"], PINHOLE["cy_px"]], [0, 0, 1]])
    project = cv2.fisheye.projectPoints if model == "fisheye" else cv2.projectPoints
    at, _ = project(points.reshape(1, -1, 3).astype(float), np.zeros(3), np.zeros(3), matrix,
                    np.array(coefficients))
    row, column = np.mgrid[:240, :320]
    error = np.abs(at.reshape(240, 320, 2) - np.stack([column, row], axis=-1))
    assert error.max() <= 1e-4  # of points in float32; a hundredth of a pixel is asked for


@pytest.mark.parametrize("model, coefficients", LENSES)
def test_a_plane_cast_through_a_lens_is_a_plane_of_points(tmp_path, model, coefficients):
    view = "".join(f"{key} = {value}\n" for key, value in PINHOLE.items())
    (tmp_path / "wall.toml").write_text(
        f'[view]\nwidth_px = 320\nheight_px = 240\n{view}distortion_model = "{model}"\n'
        f"distortion = {coefficients}\n[[plane]]\npoint_m = [0, 0, 2]\nnormal = [0.3, 0.1, -1]\n")
    scene = ts.load_scene(tmp_path / "wall.toml")
    assert scene.lens == lens_of(model, coefficients)
    points = ts.points_m(scene.depth_m, scene.lens).reshape(-1, 3)
    normal = np.array([0.3, 0.1, -1.0])
    off = (points - [0, 0, 2]) @ normal / np.linalg.norm(normal)
    assert np.abs(off).max() < 2e-6
    radial = ts.radial_from_z(ts.z_from_radial(scene.depth_m, scene.lens), scene.lens)
    assert np.allclose(radial, scene.depth_m, rtol=1e-6)


def test_point_files_hold_the_points(tmp_path):
    lens = lens_of(*LENSES[0])
    camera = ts.Camera("paper-10f0", lens=lens)
    assert camera.lens == lens
    raw = np.random.default_rng(1).poisson(500, (240, 320, 4)).astype(np.float32)
    ts.write_raw(tmp_path / "raw.npy", raw)
    decoder = ts.Decoder("hamiltonian-k4", camera)
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "p.pcd", all_points=True,
                             outputs=["depth"])
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "z.npy", kind="z")
    depth_m = decoder.decode(raw).depth_m
    assert np.allclose(np.load(tmp_path / "z.npy"), ts.z_from_radial(depth_m, lens), equal_nan=True)
    data = (tmp_path / "p.pcd").read_bytes()
    start = data.index(b"DATA binary\n") + len(b"DATA binary\n")
    points = np.frombuffer(data[start:], np.float32).reshape(240, 320, -1)[..., :3]
    assert np.array_equal(points, ts.points_m(depth_m, lens), equal_nan=True)


def test_calibrations_that_opencv_writes_are_read(tmp_path):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, which writes them, is missing")
    matrix = np.array([[220.0, 0, 158.0], [0, 222.0, 121.5], [0, 0, 1]])
    for name in ("lens.yml", "lens.yaml"):
        file = cv2.FileStorage(str(tmp_path / name), cv2.FILE_STORAGE_WRITE)
        file.write("image_width", 320)
        file.write("image_height", 240)
        file.write("camera_matrix", matrix)
        file.write("distortion_coefficients", np.array([LENSES[1][1]]))
        file.release()
        lens = ts.Camera("paper-10f0", lens={"calibration": tmp_path / name}).lens
        assert lens == ts.Lens(**PINHOLE, distortion_model="opencv",
                               distortion=tuple(LENSES[1][1]), width_px=320, height_px=240)


def test_a_lens_is_refused_for_images_that_are_not_its_own(tmp_path):
    lens = ts.Lens(**PINHOLE, width_px=320, height_px=240)
    with pytest.raises(ValueError, match="image size = 100 x 100; must be 240 x 320"):
        ts.points_m(np.ones((100, 100)), lens)
    folding = lens_of("opencv", [-0.6, 0, 0, 0])
    with pytest.raises(ValueError, match=r"lens.distortion = .* must not fold back inside the image"):
        ts.z_from_radial(np.ones((240, 320)), folding)
    ts.write_raw(tmp_path / "raw.npy", np.ones((240, 320, 4), np.float32))
    decoder = ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", lens=folding))
    with pytest.raises(OSError, match=r"raw.npy: found frames of 240 x 320 pixels; lens.distortion"):
        decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "z.npy", kind="z")


@pytest.mark.parametrize("model, coefficients", LENSES)
def test_undistorted_planes_are_those_of_the_nearest_pixels(tmp_path, model, coefficients):
    lens, ideal = lens_of(model, coefficients), ts.Lens(**PINHOLE)
    raw = np.random.default_rng(1).poisson(500, (2, 240, 320, 4)).astype(np.float32)
    ts.write_raw(tmp_path / "raw.npy", raw)
    decoder = ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", lens=lens))

    def decoded(name, **options):
        decoder.decode_recording(tmp_path / "raw.npy", tmp_path / name, frame=1, **options)
        return ts.read_depth(tmp_path / name) if name.endswith("npy") else np.load(tmp_path / name)

    before = decoded("a.npz", kind="z")
    after = decoded("b.npz", kind="z", undistort=True)
    # Where the rays of the ideal pinhole are seen: the pixel whose own ray is nearest.
    ones = np.ones((240, 320))
    rays, asked = ts.points_m(ones, lens), ts.points_m(ones, ideal)
    rays, asked = rays / rays[..., 2:], asked / asked[..., 2:]
    for row, column in ((120, 158), (60, 100), (20, 300), (230, 40)):
        if after["status"][row, column] == ts.PixelStatus.invalid:
            continue
        off = np.abs(rays - asked[row, column])[..., :2] @ [PINHOLE["fx_px"], PINHOLE["fy_px"]]
        nearest = np.unravel_index(off.argmin(), off.shape)
        window = np.s_[nearest[0] - 1:nearest[0] + 2, nearest[1] - 1:nearest[1] + 2]
        assert after["depth"][row, column] in before["depth"][window]
        assert after["signal"][row, column] in before["signal"][window]
    unseen = after["status"] == ts.PixelStatus.invalid
    for plane in ("depth", "signal", "confidence"):
        assert np.array_equal(np.isnan(after[plane]), unseen)
    # However it is written: radial distance, points, a stack.
    radial = decoded("c.npz", undistort=True)["depth"]
    assert np.allclose(ts.z_from_radial(radial, ideal), after["depth"], rtol=1e-6, equal_nan=True)
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "s.npy", stack=True, undistort=True)
    assert np.array_equal(np.load(tmp_path / "s.npy")[1], radial, equal_nan=True)


def test_undistorted_planes_are_opencvs_remap(tmp_path):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, the oracle, is missing (python3-opencv)")
    model, coefficients = LENSES[0]
    raw = np.random.default_rng(2).poisson(500, (240, 320, 4)).astype(np.float32)
    ts.write_raw(tmp_path / "raw.npy", raw)
    decoder = ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", lens=lens_of(model, coefficients)))
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "z.npy", kind="z")
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "u.npy", kind="z", undistort=True)
    matrix = np.array([[PINHOLE["fx_px"], 0, PINHOLE["cx_px"]],
                       [0, PINHOLE["fy_px"], PINHOLE["cy_px"]], [0, 0, 1]])
    x, y = cv2.initUndistortRectifyMap(matrix, np.array(coefficients), None, matrix, (320, 240),
                                       cv2.CV_32FC1)
    at_x, at_y = np.rint(x).astype(int), np.rint(y).astype(int)
    seen = (at_x >= 0) & (at_x < 320) & (at_y >= 0) & (at_y < 240)
    # Halfway between two pixels either is the nearest.
    clear = (np.abs(x - at_x) < 0.49) & (np.abs(y - at_y) < 0.49)
    expected = np.full((240, 320), np.nan, np.float32)
    expected[seen] = np.load(tmp_path / "z.npy")[at_y[seen], at_x[seen]]
    assert np.array_equal(np.load(tmp_path / "u.npy")[clear], expected[clear], equal_nan=True)


def test_undistorting_needs_a_lens(tmp_path):
    ts.write_raw(tmp_path / "raw.npy", np.ones((4, 5, 4), np.float32))
    with pytest.raises(ValueError, match=r"undistort = true; needs a camera with \[lens\]"):
        ts.Decoder("hamiltonian-k4", "paper-10f0").decode_recording(
            tmp_path / "raw.npy", tmp_path / "z.npy", undistort=True)


def test_rays_of_the_maker_stand_for_the_lens(tmp_path):
    lens = lens_of(*LENSES[0])
    raw = np.random.default_rng(3).poisson(500, (240, 320, 4)).astype(np.float32)
    ts.write_raw(tmp_path / "raw.npy", raw)
    rays = ts.points_m(np.ones((240, 320)), lens).astype(float)
    np.save(tmp_path / "slopes.npy", rays[..., :2] / rays[..., 2:])
    np.save(tmp_path / "directions.npy", 3 * rays)
    with_lens = ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", lens=lens))
    without = ts.Decoder("hamiltonian-k4", "paper-10f0")

    def z_of(decoder, **options):
        decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "z.npz", kind="z",
                                 overwrite=True, **options)
        return np.load(tmp_path / "z.npz")

    truth = z_of(with_lens)["depth"]
    for name in ("slopes.npy", "directions.npy"):
        assert np.allclose(z_of(without, rays=tmp_path / name)["depth"], truth, rtol=1e-6)
        assert ts.Lens(rays=str(tmp_path / name)) == (
            seen_by := ts.Camera("paper-10f0", lens={"rays": str(tmp_path / name)})).lens
        assert np.allclose(z_of(ts.Decoder("hamiltonian-k4", seen_by))["depth"], truth, rtol=1e-6)
        assert np.allclose(ts.points_m(np.ones((240, 320)), seen_by.lens), rays, atol=1e-6)
    blind = np.array(rays)
    blind[7, 9] = np.nan
    np.save(tmp_path / "blind.npy", blind)
    seen = z_of(without, rays=tmp_path / "blind.npy")
    assert seen["status"][7, 9] == ts.PixelStatus.invalid
    assert np.isnan(seen["depth"]).sum() == 1
    without.decode_recording(tmp_path / "raw.npy", tmp_path / "p.ply", rays=tmp_path / "blind.npy",
                             all_points=True)
    assert b"element vertex %d" % (240 * 320 - 1) in (tmp_path / "p.ply").read_bytes()[:400]


@pytest.mark.parametrize("rays, text", [
    (np.ones((240, 320, 4)), r"found shape \(240, 320, 4\); expected \(240, 320, 2\)"),
    (np.ones((24, 32, 2)), r"found shape \(24, 32, 2\)"),
    (-np.ones((240, 320, 3)), r"found the ray .* of pixel \(0, 0\); expected z > 0"),
])
def test_rays_that_are_none_are_refused(tmp_path, rays, text):
    ts.write_raw(tmp_path / "raw.npy", np.ones((240, 320, 4), np.float32))
    np.save(tmp_path / "rays.npy", rays)
    with pytest.raises(OSError, match=text):
        ts.Decoder("hamiltonian-k4", "paper-10f0").decode_recording(
            tmp_path / "raw.npy", tmp_path / "z.npy", kind="z", rays=tmp_path / "rays.npy")
