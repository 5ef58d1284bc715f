# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Option names match the C++ headers; none is missing."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

import tofsmith as ts
from tofsmith import instruments
from tofsmith._decoded_planes import multipath_planes, plane_types, plane_words, usual_planes

headers = Path(__file__).resolve().parents[2] / "include" / "tofsmith"
quick = {"trials": 1000, "method": "factorize"}

# #: Struct, header, a call that lists the options it supports when given `unknown`, and the fields
# specified in other ways.
structs = [
    ("FactorizeOptions", "design/factorize.hpp",
     lambda o: ts.design("paper-10f0", **quick, factorize=o), {"seed"}),
    ("OptimizeOptions", "design/optimize.hpp",
     lambda o: ts.design("paper-10f0", **quick, optimize=o), {"seed"}),
    ("ChipSearchOptions", "design/chip_search.hpp",
     lambda o: ts.design("paper-10f0", **quick, search=o), {"seed", "exposures"}),
    ("MultipathOptions", "decode/multipath_decoder.hpp",
     lambda o: ts.Decoder("hamiltonian-k4", "paper-10f0", multipath=o), {"status_thresholds"}),
    ("FilterOptions", "decode/filter.hpp",
     lambda o: ts.Filter("hamiltonian-k4", "paper-10f0", options=o), set()),
    ("ReturnPrior", "decode/multipath_decoder.hpp",
     lambda o: ts.Decoder("hamiltonian-k4", "paper-10f0", multipath={"prior": o}), set()),
]
# #: Struct, header, function or class whose keywords are its fields.
keywords = [
    ("EvaluateOptions", "simulate/depth_error.hpp", ts.evaluate, set()),
    ("EvaluateOptions", "simulate/depth_error.hpp", ts.generator_loss, set()),
    ("RobustnessOptions", "simulate/robustness.hpp", ts.robustness, set()),
    ("FactorizeOptions", "design/factorize.hpp", ts.factorize, set()),
    ("CaptureOptions", "simulate/capture.hpp", ts.capture, set()),
    ("DesignOptions", "design/design.hpp", ts.design, set()),
    ("RequirementOptions", "design/design.hpp", ts.find_requirements, set()),
    ("MultipathErrorOptions", "simulate/multipath_error.hpp", ts.multipath_error, set()),
    ("DecodeOptions", "decode/decoder.hpp", ts.Decoder, set()),
    ("DecodeRequest", "io/decode_recording.hpp", ts.Decoder.decode_recording,
     {"lens", "order", "policy", "other_inputs"}),
    ("TimeFilterOptions", "decode/time_filter.hpp", ts.TimeFilter, set()),
    ("ExportOptions", "waveforms/waveform_export.hpp", ts.export_waveforms, set()),
    ("ResponseRecordOptions", "calibrate/impulse_response.hpp", ts.read_response_record, set()),
    ("ResponseCalibrationOptions", "calibrate/impulse_response.hpp",
     ts.calibrate_impulse_response, {"fundamental_frequency_hz", "samples"}),
    ("DelaySweepOptions", "calibrate/correlation_calibration.hpp", ts.read_delay_sweep,
     {"unit_scale", "fundamental_frequency_hz", "samples", "table"}),
    ("CorrelationCalibrationOptions", "calibrate/correlation_calibration.hpp",
     ts.calibrate_correlation, {"taps", "differences", "range_m", "exposure_s"}),
    ("PhotonTransferOptions", "calibrate/photon_transfer.hpp", ts.photon_transfer, set()),
    ("CaptureOptions", "simulate/capture.hpp", ts.write_training_set,
     {"signal_e_per_s", "ambient_e_per_s"}),
    ("SceneSource", "io/scene_toml.hpp", ts.load_scene, {"scene"}),
]


def fields(struct, header):
    """Returns the names of the data members of a struct."""
    text = re.sub(r"//.*", "", (headers / header).read_text())
    body = re.search(rf"\nstruct {struct} {{\n(.*?)\n}};", text, re.DOTALL).group(1)
    names = re.findall(r"^  [\w:<>*]+ (\w+)\s*(?:=[^;]*)?;", body, re.MULTILINE)
    assert names, struct
    return set(names)


@pytest.mark.parametrize("struct, header, call, elsewhere", structs, ids=[s[0] for s in structs])
def test_every_option_is_accepted(struct, header, call, elsewhere):
    with pytest.raises(ValueError, match="the unknown name 'unknown'; needs one of ") as refused:
        call({"unknown": 1})
    known = re.search(r"needs one of ([\w, ]+)", str(refused.value)).group(1).split(", ")
    # design() passes the common seed to factorize, unless that has one.
    assert set(known) == fields(struct, header) - elsewhere


@pytest.mark.parametrize("struct, header, of, elsewhere", keywords,
                         ids=[f"{k[0]} of {k[2].__name__}" for k in keywords])
def test_every_option_is_a_keyword(struct, header, of, elsewhere):
    import inspect

    parameters = set(inspect.signature(of).parameters)
    assert fields(struct, header) - elsewhere <= parameters


uploads = ("UploadRequest", "waveforms/upload_script.hpp"), (
    "UploadSelection", "waveforms/upload_script.hpp")


def test_every_option_of_an_upload_is_accepted():
    import inspect

    known = set.union(*(fields(*struct) for struct in uploads)) - {"channels"} | {"tables"}
    for function in (instruments.upload_script, instruments.upload):
        assert known <= set(inspect.signature(function).parameters)
    with pytest.raises(TypeError, match="did you mean exposure?"):
        instruments.upload_script("square-k4", "paper-10f0", "33522", exposur=1)


def test_every_plane_is_an_attribute_and_can_be_decoded():
    raw = np.ones((1, 1, 9), np.float32)
    decoder = ts.Decoder("multifrequency-1x3-4x3-7x3", "paper-10f0", method="two-return")
    image = decoder.decode(raw, planes=plane_types)
    names = {field.name for field in dataclasses.fields(ts.DepthImage)}
    assert names == set(plane_types) == set(image.planes()) == set(plane_words.values())
    for name, plane in image.planes().items():
        assert plane.dtype == plane_types[name]
        assert f"{name} : ndarray of {plane.dtype}" in ts.DepthImage.__doc__
    signal = decoder.decode(raw, planes=["amplitude"]).planes()
    np.testing.assert_array_equal(signal["signal_e_per_s"], image.signal_e_per_s)
    assert set(decoder.decode(raw).planes()) == set(usual_planes + multipath_planes)


def test_every_plane_is_documented():
    page = (headers.parents[1] / "docs" / "decoding.md").read_text()
    rows = [line.split("|")[1:3] for line in page.splitlines() if line.startswith("| `")]
    for word, name in plane_words.items():
        assert any(f"`{word}`" in words and f"`{name}`" in names for words, names in rows), word
