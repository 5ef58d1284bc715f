# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith: design, simulate and decode coding functions of continuous-wave time-of-flight cameras.

Names are the same as in C++, on the command line and in files: `Camera`, `CodeSet`, `evaluate`,
`design`, `capture`, `Decoder`. All quantities are in SI units; names end in _m, _s, _hz, _e
(photo-electrons), _e_per_s or _bin. Invalid arguments raise ValueError or TypeError, file errors
OSError. Long computations accept `progress` and stop on Ctrl-C.

Submodules: `tofsmith.plot` (figures with matplotlib), `tofsmith.figures` (HTML figures for
notebooks), `tofsmith.torch` (gradients for PyTorch), `tofsmith.instruments` (waveform generators
through PyVISA), `tofsmith.paper` (figures of the paper).

Examples
--------
>>> import tofsmith
>>> camera = tofsmith.Camera("paper-10f0")
>>> code = tofsmith.build_family("hamiltonian-k4", camera)
>>> report = tofsmith.evaluate(code, camera, trials=1000)
"""

from importlib import import_module as _import_module
from types import ModuleType as _ModuleType

from . import _components  # isort: skip
from . import _check, _tofsmith
from ._actual_waveforms import actual_waveforms, arm_output, generator_report
from ._camera import Camera, built_in_camera_names, camera_keys
from ._camera_calibration import (
    CalibratedStrayLight,
    PhotonTransfer,
    TemperatureDrift,
    calibrate_stray_light,
    calibrate_temperature,
    photon_transfer,
    remove_stray_light,
)
from ._camera_fields import (
    Generator,
    ImpulseResponse,
    Lens,
    LensBlur,
    Light,
    Operating,
    OperatingInterference,
    OperatingMultipath,
    Optics,
    Playback,
    RawMarkers,
    Sensor,
    SensorTemperature,
    SquareLight,
    Temperature,
)
from ._code import (
    CodeSet,
    build_family,
    list_families,
    load_code,
    read_code,
    require_fits,
    why_not_playable,
    write_code,
)
from ._correlation_calibration import (
    CalibratedCorrelation,
    DeadPixels,
    DelaySweep,
    IdealCodeFit,
    calibrate_correlation,
    fit_ideal_codes,
    read_delay_sweep,
    write_correlation_report,
)
from ._depth_calibration import CalibratedDepth, CalibratedFrequency
from ._decode import Decoder, decode
from ._decoded_planes import PixelStatus, ReturnStatus
from ._decoding_table import DecodingTable
from ._depth_image import DepthImage
from ._design import (
    AtlasEntry,
    Candidate,
    DesignResult,
    RequirementMap,
    Requirements,
    Sufficiency,
    atlas,
    design,
    find_requirements,
    suggested_exposures,
)
from ._evaluate import (
    CramerRaoBound,
    DirectTofBound,
    HistogramBound,
    ReceiverBound,
    best_rotation,
    evaluate,
    generator_loss,
    interference_error,
    motion_error,
    robustness,
    table_depth_error_m,
)
from ._export import ExportedCode, WaveformFormat, export_waveforms, waveform_formats
from ._factorize import Alternation, FactorizedPair, Factorization, alternate, factorize
from ._files import (
    read_correlation_functions,
    read_depth,
    read_impulse_response,
    read_measured_table,
    read_raw,
    write_depth,
    write_points,
    write_raw,
)
from ._filter import Filter, TimeFilter, merge_exposures
from ._option_fields import (
    ChipSearchOptions,
    FactorizeOptions,
    FilterOptions,
    MultipathOptions,
    OptimizeOptions,
    ReturnPrior,
    TimeFilterOptions,
)
from ._forward_model import (
    ForwardModel,
    coding_curve_in_space,
    coding_curve_length,
    coding_curve_rank,
    harmonics_used,
)
from ._light import ExponentialTail, MultipathReturns, Transients
from ._multipath import (
    MultipathBound,
    MultipathCells,
    MultipathErrorReport,
    MultipathMaps,
    multipath_error,
    single_path_bias_m,
)
from ._recordings import DecodedRecording, DecodedStream
from ._report_pages import write_evaluation_report, write_report
from ._reports import DepthErrorReport, GeneratorLoss, OperatingMultipathReport
from ._response_calibration import (
    CalibratedResponse,
    ResponseRecord,
    calibrate_impulse_response,
    read_response_record,
)
from ._result_fields import (
    DepthErrorMean,
    ExposureOrder,
    GeneratorReport,
    HarmonicRatio,
    InterferenceReport,
    MeasurementReport,
    MotionErrors,
    MotionReport,
    ParametricResponse,
    PhotonTransferPoint,
    RobustnessReport,
    SearchRecord,
    SensorDrift,
    TrainingSetRun,
    WrongShares,
)
from ._results import Estimate
from ._scene import (
    Scene,
    StagedCapture,
    bounced_light,
    built_in_scene,
    built_in_scene_names,
    capture,
    capture_staged,
    centred_lens,
    load_scene,
    points_m,
    radial_from_z,
    z_from_radial,
)
from ._sweep import SweepResults, read_sweep, read_sweep_export, run_sweep
from ._tofsmith import Interrupted
from ._training_set import write_training_set
from ._waveform import Waveform

__version__: str = _tofsmith.version


def __getattr__(name: str) -> _ModuleType:
    """Imports tofsmith.figures, instruments, paper, plot or torch on first use."""
    if name in ("figures", "instruments", "paper", "plot", "torch"):
        return _import_module(f"{__name__}.{name}")
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")


def build_info() -> dict[str, str | list[str]]:
    """Returns the version and configuration of the build, as printed by ``tofsmith --version``.

    Returns
    -------
    dict
        ``version``; ``commit``, 12 digits with ``+dirty`` if files differed, or ``unknown``;
        ``compiler``; ``build_type``; ``library``, ``shared`` or ``static``; ``targets``,
        instruction sets with specialized kernels, best first; ``features``, the optional features
        of this build.
    """
    return _tofsmith.build_info()


def set_threads(threads: int) -> None:
    """Limits the number of threads; 0: one per core. Results do not depend on it."""
    _tofsmith.set_threads(_check.whole(threads, "threads", 0, 65536))


__all__ = [
    "Alternation",
    "AtlasEntry",
    "CalibratedCorrelation",
    "CalibratedDepth",
    "CalibratedFrequency",
    "CalibratedResponse",
    "CalibratedStrayLight",
    "Camera",
    "Candidate",
    "ChipSearchOptions",
    "CodeSet",
    "CramerRaoBound",
    "DeadPixels",
    "DecodedRecording",
    "DecodedStream",
    "Decoder",
    "DecodingTable",
    "DelaySweep",
    "DepthErrorMean",
    "DepthErrorReport",
    "DepthImage",
    "DesignResult",
    "DirectTofBound",
    "Estimate",
    "ExponentialTail",
    "ExportedCode",
    "ExposureOrder",
    "FactorizeOptions",
    "FactorizedPair",
    "Factorization",
    "Filter",
    "FilterOptions",
    "ForwardModel",
    "Generator",
    "GeneratorLoss",
    "GeneratorReport",
    "HarmonicRatio",
    "HistogramBound",
    "IdealCodeFit",
    "ImpulseResponse",
    "InterferenceReport",
    "Interrupted",
    "MultipathReturns",
    "Lens",
    "LensBlur",
    "Light",
    "MeasurementReport",
    "MotionErrors",
    "MotionReport",
    "MultipathBound",
    "MultipathCells",
    "MultipathErrorReport",
    "MultipathMaps",
    "MultipathOptions",
    "Operating",
    "Optics",
    "OptimizeOptions",
    "ParametricResponse",
    "PhotonTransfer",
    "PhotonTransferPoint",
    "PixelStatus",
    "Playback",
    "RawMarkers",
    "ReceiverBound",
    "RequirementMap",
    "Requirements",
    "ResponseRecord",
    "ReturnPrior",
    "ReturnStatus",
    "RobustnessReport",
    "Scene",
    "SearchRecord",
    "OperatingMultipathReport",
    "OperatingInterference",
    "OperatingMultipath",
    "Sensor",
    "SensorDrift",
    "SensorTemperature",
    "SquareLight",
    "StagedCapture",
    "Sufficiency",
    "SweepResults",
    "Temperature",
    "TemperatureDrift",
    "TimeFilter",
    "TimeFilterOptions",
    "TrainingSetRun",
    "Transients",
    "Waveform",
    "WrongShares",
    "WaveformFormat",
    "actual_waveforms",
    "alternate",
    "arm_output",
    "atlas",
    "best_rotation",
    "bounced_light",
    "build_family",
    "build_info",
    "built_in_camera_names",
    "built_in_scene",
    "built_in_scene_names",
    "calibrate_correlation",
    "calibrate_impulse_response",
    "calibrate_stray_light",
    "calibrate_temperature",
    "camera_keys",
    "capture",
    "capture_staged",
    "centred_lens",
    "coding_curve_in_space",
    "coding_curve_length",
    "coding_curve_rank",
    "decode",
    "design",
    "evaluate",
    "export_waveforms",
    "factorize",
    "find_requirements",
    "fit_ideal_codes",
    "generator_loss",
    "generator_report",
    "harmonics_used",
    "interference_error",
    "list_families",
    "load_code",
    "load_scene",
    "merge_exposures",
    "motion_error",
    "multipath_error",
    "photon_transfer",
    "points_m",
    "radial_from_z",
    "read_code",
    "read_correlation_functions",
    "read_delay_sweep",
    "read_depth",
    "read_impulse_response",
    "read_measured_table",
    "read_raw",
    "read_response_record",
    "read_sweep",
    "read_sweep_export",
    "remove_stray_light",
    "require_fits",
    "robustness",
    "run_sweep",
    "set_threads",
    "single_path_bias_m",
    "suggested_exposures",
    "table_depth_error_m",
    "waveform_formats",
    "why_not_playable",
    "write_code",
    "write_correlation_report",
    "write_depth",
    "write_evaluation_report",
    "write_points",
    "write_raw",
    "write_report",
    "write_training_set",
    "z_from_radial",
]
