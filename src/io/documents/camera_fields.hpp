// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "core/shared/enum_words.hpp"
#include "tofsmith/camera/camera.hpp"

// The tables and keys of a camera file, described once for reading and for writing: `Table` is a
// TableReader or a TableWriter, which sees const fields. Only a measured response, a map of
// rays and a calibrated lens are read and written differently: visit_measured_response(),
// visit_ray_map() and visit_lens_calibration() are overloaded for both.
namespace tofsmith::camera_fields {

inline constexpr EnumWords<NoiseModel, 2> noise_models("NoiseModel", "noise", "poisson",
                                                       "gaussian");
inline constexpr EnumWords<Readout, 3> readouts("Readout", "readout", "separate", "difference",
                                                "rows");
inline constexpr EnumWords<Demodulation, 2> demodulations("Demodulation", "demodulation", "gain",
                                                          "signed");
inline constexpr EnumWords<LensBlur::Kind, 3> blurs("LensBlur::Kind", "blur", "none", "gaussian",
                                                    "disc");

/// The member that a reader may change and a writer only sees.
template <typename Table, typename Value>
using Field = std::conditional_t<Table::reads, Value, const Value>;

template <typename Table>
void visit_impulse_response(Table& table, Field<Table, ImpulseResponse>& response) {
  using Kind = ImpulseResponse::Kind;
  table.required("kind", "\"hann\"");
  table.choice("kind", response.kind, words_by_name<Kind, 5>("ImpulseResponse::Kind", "kind"));
  const Kind kind = response.kind;
  if (kind == Kind::hann)
    table.required("f_max_hz", "150e6").value("f_max_hz", response.f_max_hz);
  else
    table.refuse({"f_max_hz"}, "kind = \"hann\"");
  if (kind == Kind::gaussian || kind == Kind::lowpass)
    table.required("cutoff_hz", "100e6").value("cutoff_hz", response.cutoff_hz);
  else
    table.refuse({"cutoff_hz"}, "kind = \"gaussian\" or \"lowpass\"");
  if (kind == Kind::file)
    visit_measured_response(table, response);
  else
    table.refuse({"file", "samples", "time_step_s"}, "kind = \"file\"");
}

template <typename Table>
void visit_generator(Table& table, Field<Table, Generator>& generator) {
  table.value("sample_rate_hz", generator.sample_rate_hz);
  table.value("amplitude_bits", generator.amplitude_bits);
  table.value("table_points", generator.table_points);
  table.value("edge_grid_s", generator.edge_grid_s);
}

template <typename Table>
void visit_light(Table& table, Field<Table, LightSource>& light) {
  table.value("peak_factor", light.peak_factor);
  table.value("binary", light.binary);
  table.table("impulse_response", light.impulse_response, visit_impulse_response<Table>);
  table.value("edge_jitter_s", light.edge_jitter_s);
  table.table("generator", light.generator, visit_generator<Table>);
}

template <typename Table>
void visit_sensor(Table& table, Field<Table, Sensor>& sensor) {
  table.value("taps", sensor.taps);
  table.value("binary", sensor.binary);
  table.table("impulse_response", sensor.impulse_response, visit_impulse_response<Table>);
  table.value("edge_jitter_s", sensor.edge_jitter_s);
  table.table("generator", sensor.generator, visit_generator<Table>);
  table.value("read_noise_e", sensor.read_noise_e);
  table.choice("noise", sensor.noise, noise_models);
  table.value("dark_current_e_per_s", sensor.dark_current_e_per_s);
  table.number_or_list("modulation_contrast", sensor.modulation_contrast,
                       sensor.modulation_contrasts);
  table.value("tap_mismatch", sensor.tap_mismatch);
  table.value("full_well_e", sensor.full_well_e);
  table.value("adc_bits", sensor.adc_bits);
  table.value("gain_e_per_dn", sensor.gain_e_per_dn);
  table.value("black_level_dn", sensor.black_level_dn);
  table.value("shortest_pulse_s", sensor.shortest_pulse_s);
  table.value("drain", sensor.drain);
  table.choice("readout", sensor.readout, readouts);
  table.choice("demodulation", sensor.demodulation, demodulations);
  table.value("readout_gap_s", sensor.readout_gap_s);
  table.value("frame_period_s", sensor.frame_period_s);
}

template <typename Table>
void visit_raw(Table& table, Field<Table, RawMarkers>& raw) {
  table.markers("saturated", raw.saturated);
  table.markers("invalid", raw.invalid);
}

template <typename Table>
void visit_distortion(Table& table, Field<Table, LensDistortion>& distortion) {
  table.choice("distortion_model", distortion.model,
               words_by_name<DistortionModel, 2>("DistortionModel", "distortion_model"));
  table.required("distortion", "[-0.3, 0.1, 0.0, 0.0]")
      .value("distortion", distortion.coefficients);
}

/// The pinhole as numbers, or all of it in a calibration file; or a map of rays in its place.
template <typename Table>
void visit_pinhole(Table& table, Field<Table, Lens>& lens) {
  if (visit_ray_map(table, lens)) {
    table.refuse({"fx_px", "fy_px", "cx_px", "cy_px", "distortion_model", "distortion", "width_px",
                  "height_px", "calibration"},
                 "no rays beside it");
    return;
  }
  if (visit_lens_calibration(table, lens)) {
    table.refuse({"fx_px", "fy_px", "cx_px", "cy_px", "distortion", "width_px", "height_px"},
                 "no calibration beside it");
    return;
  }
  table.required("fx_px", "525.0").value("fx_px", lens.fx_px);
  table.required("fy_px", "525.0").value("fy_px", lens.fy_px);
  table.required("cx_px", "319.5").value("cx_px", lens.cx_px);
  table.required("cy_px", "239.5").value("cy_px", lens.cy_px);
  table.part(lens.distortion, {"distortion_model", "distortion"}, visit_distortion<Table>);
  table.value("width_px", lens.width_px);
  table.value("height_px", lens.height_px);
}

template <typename Table>
void visit_blur(Table& table, Field<Table, LensBlur>& blur) {
  using Kind = LensBlur::Kind;
  table.choice("blur", blur.kind, blurs);
  if (blur.kind == Kind::gaussian)
    table.required("blur_sigma_px", "0.5").value("blur_sigma_px", blur.blur_sigma_px);
  else
    table.refuse({"blur_sigma_px"}, "blur = \"gaussian\"");
  if (blur.kind == Kind::disc) {
    table.required("focal_length_m", "4e-3").value("focal_length_m", blur.focal_length_m);
    table.required("f_number", "1.4").value("f_number", blur.f_number);
    table.required("focus_distance_m", "1.0").value("focus_distance_m", blur.focus_distance_m);
    table.required("pixel_pitch_m", "10e-6").value("pixel_pitch_m", blur.pixel_pitch_m);
  } else {
    table.refuse({"focal_length_m", "f_number", "focus_distance_m", "pixel_pitch_m"},
                 "blur = \"disc\"");
  }
  table.value("pixel_samples", blur.pixel_samples);
}

/// The pinhole and the blur, each there if one of its keys is.
template <typename Table>
void visit_lens(Table& table, Field<Table, Camera>& camera) {
  table.part(camera.lens,
             {"fx_px", "fy_px", "cx_px", "cy_px", "distortion_model", "distortion", "width_px",
              "height_px", "calibration", "rays"},
             visit_pinhole<Table>);
  table.part(camera.blur,
             {"blur", "blur_sigma_px", "focal_length_m", "f_number", "focus_distance_m",
              "pixel_pitch_m", "pixel_samples"},
             visit_blur<Table>);
}

template <typename Table>
void visit_optics(Table& table, Field<Table, Optics>& optics) {
  table.required("source_power_w", "0.5").value("source_power_w", optics.source_power_w);
  table.required("wavelength_m", "850e-9").value("wavelength_m", optics.wavelength_m);
  table.required("field_of_view_deg", "[70, 55]")
      .value("field_of_view_deg", optics.field_of_view_deg);
  table.required("f_number", "1.4").value("f_number", optics.f_number);
  table.required("pixel_pitch_m", "10e-6").value("pixel_pitch_m", optics.pixel_pitch_m);
  table.required("quantum_efficiency", "0.3")
      .value("quantum_efficiency", optics.quantum_efficiency);
  table.value("transmission", optics.transmission);
  table.value("fill_factor", optics.fill_factor);
  table.value("filter_width_m", optics.filter_width_m);
  table.value("sunlight_klux", optics.sunlight_klux);
  table.value("sunlight_w_per_m2_nm", optics.sunlight_w_per_m2_nm);
}

template <typename Table>
void visit_operating_multipath(Table& table, Field<Table, OperatingMultipath>& returns) {
  table.value("ratio", returns.ratio);
  table.value("delay_m", returns.delay_m);
  table.value("weight", returns.weight);
}

template <typename Table>
void visit_operating(Table& table, Field<Table, OperatingRange>& range) {
  table.value("signal_e_per_s", range.signal_e_per_s);
  table.value("ambient_e_per_s", range.ambient_e_per_s);
  table.choice("error", range.error, words_by_name<DepthErrorKind, 2>("DepthErrorKind", "error"));
  table.number_or_word("albedo", range.albedo, "uniform", range.uniform_albedo);
  table.value("neighbours", range.neighbours);
  table.value("working_distance_m", range.working_distance_m);
  table.value("depths", range.depths);
  table.table("multipath", range.multipath, visit_operating_multipath<Table>);
}

template <typename Table>
void visit_playback(Table& table, Field<Table, Playback>& playback) {
  table.value("order", playback.order);
  table.value("reversed", playback.reversed);
  table.value("inverted", playback.inverted);
  table.value("offset_m", playback.offset_m);
}

template <typename Table>
void visit_temperature(Table& table, Field<Table, Temperature>& temperature) {
  table.value("reference_c", temperature.reference_c);
  table.value("offset_m_per_c", temperature.offset_m_per_c);
  table.value("signal_per_c", temperature.signal_per_c);
  table.value("now_c", temperature.now_c);
}

template <typename Table>
void visit_camera(Table& table, Field<Table, Camera>& camera) {
  table.value("name", camera.name);
  table.required("fundamental_frequency_hz", "15e6")
      .value("fundamental_frequency_hz", camera.fundamental_frequency_hz);
  table.number_or_list("exposure_s", camera.exposure_s.total_s, camera.exposure_s.each_s);
  table.value("samples", camera.samples);
  table.table("light", camera.light, visit_light<Table>);
  table.table("sensor", camera.sensor, visit_sensor<Table>);
  table.table("raw", camera.raw, visit_raw<Table>);
  table.table("lens", camera, visit_lens<Table>);
  table.table("optics", camera.optics, visit_optics<Table>);
  table.table("operating", camera.operating, visit_operating<Table>);
  table.table("playback", camera.playback, visit_playback<Table>);
  table.table("temperature", camera.temperature, visit_temperature<Table>);
}

}  // namespace tofsmith::camera_fields
