# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Lens distortion, compared with OpenCV."""

import numpy as np
import pytest

import tofsmith as ts

PINHOLE = {"fx_px": 220.0, "fy_px": 222.0, "cx_px": 158.0, "cy_px": 121.5}
MATRIX = np.array([[220.0, 0, 158.0], [0, 222.0, 121.5], [0, 0, 1]])  # of PINHOLE, for OpenCV
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
def test_opencv_projects_the_ray_of_a_pixel_to_that_pixel(model, coefficients):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, the oracle, is missing (python3-opencv)")
    points = ts.points_m(np.ones((240, 320)), lens_of(model, coefficients))
    project = cv2.fisheye.projectPoints if model == "fisheye" else cv2.projectPoints
    at, _ = project(points.reshape(1, -1, 3).astype(float), np.zeros(3), np.zeros(3), MATRIX,
                    np.array(coefficients))
    row, column = np.mgrid[:240, :320]
    error = np.abs(at.reshape(240, 320, 2) - np.stack([column, row], axis=-1))
    assert error.max() <= 1e-4  # for points in float32; the requirement is 0.01 pixels


def test_reads_calibrations_written_by_opencv(tmp_path):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, which writes them, is missing")
    for name in ("lens.yml", "lens.yaml"):
        file = cv2.FileStorage(str(tmp_path / name), cv2.FILE_STORAGE_WRITE)
        file.write("image_width", 320)
        file.write("image_height", 240)
        file.write("camera_matrix", MATRIX)
        file.write("distortion_coefficients", np.array([LENSES[1][1]]))
        file.release()
        lens = ts.Camera("paper-10f0", lens={"calibration": tmp_path / name}).lens
        assert lens == ts.Lens(**PINHOLE, distortion_model="opencv",
                               distortion=tuple(LENSES[1][1]), width_px=320, height_px=240)


def test_undistorted_planes_equal_opencv_remap(tmp_path):
    cv2 = pytest.importorskip("cv2", reason="OpenCV, the oracle, is missing (python3-opencv)")
    model, coefficients = LENSES[1]
    raw = np.random.default_rng(2).poisson(500, (240, 320, 4)).astype(np.float32)
    ts.write_raw(tmp_path / "raw.npy", raw)
    decoder = ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", lens=lens_of(model, coefficients)))
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "z.npy", kind="z")
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "u.npy", kind="z", undistort=True)
    x, y = cv2.initUndistortRectifyMap(MATRIX, np.array(coefficients), None, MATRIX, (320, 240),
                                       cv2.CV_32FC1)
    at_x, at_y = np.rint(x).astype(int), np.rint(y).astype(int)
    seen = (at_x >= 0) & (at_x < 320) & (at_y >= 0) & (at_y < 240)
    # Half-way between two pixels, either may be the nearest.
    clear = (np.abs(x - at_x) < 0.49) & (np.abs(y - at_y) < 0.49)
    expected = np.full((240, 320), np.nan, np.float32)
    expected[seen] = np.load(tmp_path / "z.npy")[at_y[seen], at_x[seen]]
    assert np.array_equal(np.load(tmp_path / "u.npy")[clear], expected[clear], equal_nan=True)
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "u.npz", kind="z", undistort=True)
    planes = np.load(tmp_path / "u.npz")
    unseen = planes["status"] == ts.PixelStatus.invalid
    assert unseen.any() and np.array_equal(unseen[clear], ~seen[clear])
    for plane in ("depth", "signal", "confidence"):
        assert np.isnan(planes[plane][unseen]).all()
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "s.npy", kind="z", stack=True, undistort=True)
    assert np.array_equal(np.load(tmp_path / "s.npy")[0], planes["depth"], equal_nan=True)


def test_ray_tables_replace_the_lens_model(tmp_path):
    lens = lens_of(*LENSES[0])
    rays = ts.points_m(np.ones((240, 320)), lens).astype(float)
    blind = 3 * rays
    blind[7, 9] = np.nan
    np.save(tmp_path / "slopes.npy", rays[..., :2] / rays[..., 2:])
    np.save(tmp_path / "blind.npy", blind)
    seen_by = ts.Camera("paper-10f0", lens={"rays": str(tmp_path / "slopes.npy")})
    assert ts.Lens(rays=str(tmp_path / "slopes.npy")) == seen_by.lens
    assert np.allclose(ts.points_m(np.ones((240, 320)), seen_by.lens), rays, atol=1e-6)
    ts.write_raw(tmp_path / "raw.npy", np.random.default_rng(3).poisson(500, (240, 320, 4)))

    def z_of(camera, **options):
        ts.Decoder("hamiltonian-k4", camera).decode_recording(
            tmp_path / "raw.npy", tmp_path / "z.npz", kind="z", overwrite=True, **options)
        return np.load(tmp_path / "z.npz")

    truth = z_of(ts.Camera("paper-10f0", lens=lens))["depth"]
    assert np.allclose(z_of(seen_by)["depth"], truth, rtol=1e-6)
    found = z_of("paper-10f0", rays=tmp_path / "blind.npy")
    assert found["status"][7, 9] == ts.PixelStatus.invalid
    assert np.isnan(found["depth"]).sum() == 1
    truth[7, 9] = np.nan
    assert np.allclose(found["depth"], truth, rtol=1e-6, equal_nan=True)


def test_rejects_lenses_that_do_not_fit(tmp_path):
    with pytest.raises(ValueError, match="image size = 100 x 100; must be 240 x 320"):
        ts.points_m(np.ones((100, 100)), ts.Lens(**PINHOLE, width_px=320, height_px=240))
    ts.write_raw(tmp_path / "raw.npy", np.ones((240, 320, 4), np.float32))
    folding = ts.Camera("paper-10f0", lens=lens_of("opencv", [-0.6, 0, 0, 0]))
    for camera, rays, options, error, text in (
            (folding, None, {}, OSError, "raw.npy: found frames of 240 x 320 pixels; lens.distortion"),
            ("paper-10f0", np.ones((24, 32, 2)), {}, OSError, r"found shape \(24, 32, 2\)"),
            ("paper-10f0", -np.ones((240, 320, 3)), {}, OSError, r"found the ray .* of pixel \(0, 0\); expected z > 0"),
            ("paper-10f0", None, {"undistort": True}, ValueError, r"undistort = true; requires a camera with \[lens\]")):
        if rays is not None:
            np.save(tmp_path / "rays.npy", rays)
            options = {"rays": tmp_path / "rays.npy"}
        with pytest.raises(error, match=text):
            ts.Decoder("hamiltonian-k4", camera).decode_recording(
                tmp_path / "raw.npy", tmp_path / "z.npy", kind="z", **options)
