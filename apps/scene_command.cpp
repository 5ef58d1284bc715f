// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "fresh_directory.hpp"
#include "scene_source.hpp"
#include "session.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {
namespace {

/// Returns a page with the radial distance and the returned light of a scene.
Page preview_page(const SceneImage& scene, const std::string& name) {
  Image<float> light(scene.height(), scene.width());
  for (std::size_t i = 0; i < light.size(); ++i)
    light.pixels[i] = std::isfinite(scene.depth_m.pixels[i])
                          ? scene.albedo.pixels[i] * scene.cosine.pixels[i]
                          : std::numeric_limits<float>::quiet_NaN();
  return {.title = name,
          .subtitle = fmt::format("{} x {} pixels", scene.width(), scene.height()),
          .sections = {{"Scene",
                        {image_figure({.id = "depth",
                                       .title = "Radial distance",
                                       .caption = "Pixels without return are empty."},
                                      {{.title = "", .pixels = scene.depth_m}},
                                      {.label = "distance", .unit = "m", .clip_fraction = 0.005}),
                         image_figure({.id = "light",
                                       .title = "Returned light",
                                       .caption = "Albedo times cosine of the angle of incidence."},
                                      {{.title = "", .pixels = std::move(light)}},
                                      {.label = "albedo x cosine",
                                       .map = ColourMap::cividis,
                                       .range = ValueRange{0.0, 1.0}})},
                        SectionLayout::front}},
          .footer = "tofsmith " TOFSMITH_VERSION};
}

namespace fs = std::filesystem;

struct SceneArguments {
  SceneSource scene;
  CameraArguments camera;
  std::string output;
};

void list_scenes(const Session& session) {
  const std::vector<std::string> names = built_in_scene_names();
  session.print_json({{"scenes", names}});
  session.say(fmt::format("{}", fmt::join(names, "\n")));
}

void write_directory(const fs::path& directory, const LoadedScene& scene, const Camera& camera,
                     const Session& session) {
  const FreshDirectory cleanup(directory);
  make_output_directory(directory);
  // z is unknown for a depth image without a lens.
  const bool has_view = scene.staged || camera.lens;
  std::vector<fs::path> outputs;
  for (const char* name :
       {"depth.npy", "albedo.npy", "cosine.npy", "beyond_range.npy", "preview.html"})
    outputs.push_back(directory / name);
  if (has_view) outputs.insert(outputs.begin() + 1, directory / "z.npy");
  const OutputPolicy policy = session.check_outputs(outputs);
  const SceneImage& image = scene.image;
  write_float_image(directory / "depth.npy", image.depth_m, "depth", policy);
  if (has_view)
    write_float_image(directory / "z.npy", z_from_radial(image.depth_m, scene.view), "z", policy);
  else
    session.say("note: no z.npy, because the camera has no [lens]");
  write_float_image(directory / "albedo.npy", image.albedo, "albedo", policy);
  write_float_image(directory / "cosine.npy", image.cosine, "cosine", policy);
  const NpyShape shape{static_cast<std::size_t>(image.height()),
                       static_cast<std::size_t>(image.width())};
  write_npy(directory / "beyond_range.npy",
            NpyArray::of<std::uint8_t>(shape, beyond_range(image, camera).pixels), policy);
  write_file_atomically(directory / "preview.html", render(preview_page(image, scene.name)),
                        policy);
}

void print(const LoadedScene& scene, const Camera& camera, const std::string& output,
           const Session& session) {
  const SceneExtent extent = scene_extent(scene.image, camera);
  const auto distance = [&](double metres) -> nlohmann::ordered_json {
    if (extent.returns == 0) return nullptr;
    return metres;
  };
  session.print_json({{"scene", scene.name},
                      {"height", scene.image.height()},
                      {"width", scene.image.width()},
                      {"nearest_m", distance(extent.nearest_m)},
                      {"median_m", distance(extent.median_m)},
                      {"farthest_m", distance(extent.farthest_m)},
                      {"no_return_share", extent.no_return_share()},
                      {"camera", camera.name},
                      {"range_m", extent.range_m},
                      {"beyond_range_share", extent.beyond_range_share()},
                      {"output", output}});
  session.say(fmt::format("{}: {} x {} pixels, {:.3g} % without return", scene.name,
                          scene.image.height(), scene.image.width(),
                          100.0 * extent.no_return_share()));
  if (extent.returns > 0)
    session.say(fmt::format("distance: nearest {}, median {}, farthest {}",
                            length_text(extent.nearest_m), length_text(extent.median_m),
                            length_text(extent.farthest_m)));
  if (extent.beyond_range > 0) session.say(beyond_range_remark(extent));
  if (const std::string remark = albedo_remark(scene); !remark.empty()) session.say(remark);
  if (!output.empty()) session.say(fmt::format("wrote {}", output));
}

void run(const SceneArguments& arguments, const Session& session) {
  const std::string& output = arguments.output;
  if (arguments.scene.scene.empty()) {
    if (!output.empty())
      throw UsageError("-o requires a SCENE; `tofsmith scene` lists the built-in scenes");
    return list_scenes(session);
  }
  const Camera camera = arguments.camera.load();
  const bool is_file = fs::path(output).has_extension() && !fs::is_directory(output);
  if (is_file) session.check_output(output);
  const LoadedScene scene = scene_of(arguments.scene, camera);
  if (is_file)
    write_depth(output, scene.image.depth_m, session.output_policy());
  else if (!output.empty())
    write_directory(output, scene, camera, session);
  print(scene, camera, output, session);
}

}  // namespace

void add_scene_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<SceneArguments>();
  CLI::App* command = app.add_subcommand("scene", "preview a scene, or list the built-in scenes");
  command->add_option("SCENE", arguments->scene.scene, scene_help);
  add_scene_options(*command, arguments->scene);
  arguments->camera.add_to(*command);
  command
      ->add_option("--time-s", arguments->scene.time_s,
                   "time at which a moving scene is rendered [s]; frame 0 begins at 0")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output,
                      "directory for radial distance, z-depth, albedo, cosine of the angle of "
                      "incidence, a mask of pixels beyond the range and a preview; or one file for "
                      "the radial distance (.npy .npz .exr .pfm .png)");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
