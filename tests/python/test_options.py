# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Names of options and planes match the library; none is missing. The compiler checks that
descriptions contain all fields (lists_every_field in core/fields.hpp)."""

import dataclasses
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import tofsmith as ts
from tofsmith._decoded_planes import multipath_planes, plane_types, plane_words, usual_planes
from tofsmith._option_fields import OPTIONS

headers = Path(__file__).resolve().parents[2] / "include" / "tofsmith"
quick = {"trials": 1000, "method": "factorize"}

# #: Dicts of options, with a call that lists the options it supports when given `unknown`.
nested = {
    ts.FactorizeOptions: lambda o: ts.design("paper-10f0", **quick, factorize=o),
    ts.OptimizeOptions: lambda o: ts.design("paper-10f0", **quick, optimize=o),
    ts.ChipSearchOptions: lambda o: ts.design("paper-10f0", **quick, search=o),
    ts.MultipathOptions: lambda o: ts.Decoder("hamiltonian-k4", "paper-10f0", multipath=o),
    ts.FilterOptions: lambda o: ts.Filter("hamiltonian-k4", "paper-10f0", options=o),
    ts.ReturnPrior: lambda o: ts.Decoder("hamiltonian-k4", "paper-10f0", multipath={"prior": o}),
}
# #: Structs whose functions list the keywords, their headers, and the fields specified in other ways.
keywords = [
    ("CorrelationCalibrationOptions", "correlation_calibration.hpp", ts.calibrate_correlation,
     {"taps", "differences", "range_m", "exposure_s"}),
]


@pytest.mark.parametrize("kind", nested, ids=lambda kind: kind.__name__)
def test_described_options_are_those_that_are_accepted(kind):
    with pytest.raises(ValueError, match="the unknown name 'unknown'; needs one of ") as refused:
        nested[kind]({"unknown": 1})
    known = re.search(r"needs one of ([\w, ]+)", str(refused.value)).group(1).split(", ")
    assert known == [option.name for option in OPTIONS[kind]]


def functions_with_described_options():
    """Public functions, constructors and methods decorated with takes()."""
    for owner in (*(getattr(ts, name) for name in ts.__all__), *vars(ts.instruments).values()):
        for value in (owner, *(vars(owner).values() if inspect.isclass(owner) else ())):
            value = getattr(value, "__func__", value)  # of a class method
            wrapped = getattr(value, "__wrapped__", None)
            if inspect.isfunction(wrapped) and "options" in inspect.signature(wrapped).parameters:
                yield value


described_functions = list(functions_with_described_options())


def test_functions_with_described_options_are_found():
    assert {ts.Decoder.__init__, ts.DecodingTable.load.__func__, ts.evaluate,
            ts.instruments.upload} <= set(described_functions)


@pytest.mark.parametrize("function", described_functions,
                         ids=lambda function: function.__qualname__)
def test_keywords_are_those_of_the_annotated_class(function):
    own = dict(inspect.signature(function.__wrapped__).parameters)
    annotation = own.pop("options").annotation
    (described,) = [options for kind, options in OPTIONS.items()
                    if annotation == f"Unpack[{kind.__name__}]"]
    assert list(inspect.signature(function).parameters) == [*own, *(o.name for o in described)]


@pytest.mark.parametrize("struct, header, function, elsewhere", keywords,
                         ids=[k[0] for k in keywords])
def test_every_field_is_a_keyword(struct, header, function, elsewhere):
    text = (headers / "calibrate" / header).read_text()
    body = re.search(rf"\nstruct {struct} {{\n(.*?)\n}};", text, re.DOTALL).group(1)
    fields = re.findall(r"^  [\w:<>*]+ (\w+)\s*(?:=[^;]*)?;", re.sub("//.*", "", body), re.MULTILINE)
    assert fields and set(fields) - elsewhere <= set(inspect.signature(function).parameters)


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
