#include "map_options.hpp"

#include "batch.hpp"
#include "console.hpp"
#include "diagnostic/error.hpp"
#include "io/image_file.hpp"
#include "options.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <map>
#include <set>

namespace surfgrad::cli {

void add_green_option(CLI::App& verb, const std::string& name, stack::Green& green, const std::string& what) {
  const std::map<std::string, stack::Green> greens{{"up", stack::Green::up}, {"down", stack::Green::down}};
  verb.add_option(name, green, what + ": up (default; glTF, Unity, Godot, Blender) or down (Unreal)")
      ->transform(one_of(greens))
      ->type_name("NAME")
      ->option_text("NAME");
}

void add_channels_option(CLI::App& verb, const std::string& name, maps::Channels& channels,
                         const std::string& what) {
  verb.add_option_function<std::string>(
          name,
          [&channels, name](const std::string& text) {
            const std::set<char> different(text.begin(), text.end());
            if (text.empty() || text.size() > 3 || different.size() != text.size() ||
                text.find_first_not_of("rgba") != std::string::npos)
              throw CLI::ValidationError(
                  name, "\"" + text + "\" are not one to three different letters of r, g, b and a");
            channels = maps::channels_of(text);
          },
          what)
      ->type_name("LETTERS");
}

void add_derivative_options(CLI::App& verb, const std::string& prefix, maps::Form& form) {
  verb.add_option(prefix + "range", form.range, "derivatives: slope of the largest code (default: 1)")
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            double range = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), range);
            const bool is_slope =
                error == std::errc() && end == text.data() + text.size() && range > 0 && range <= max_slope;
            return is_slope ? "" : fmt::format("must be a slope above 0, up to {}", max_slope);
          },
          ""))
      ->type_name("SLOPE");
  const std::map<std::string, stack::NeutralCode> neutrals{{"between", stack::NeutralCode::between},
                                                           {"whole", stack::NeutralCode::whole}};
  verb.add_option(prefix + "neutral", form.neutral,
                  "derivatives: code that means flat: between (default), 127.5 of 255, or whole, 128")
      ->transform(one_of(neutrals))
      ->type_name("NAME")
      ->option_text("NAME");
}

bake::BaseRoughness base_roughness_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) {
    if (!(value >= 0 && value <= 1))
      throw CLI::ValidationError("--base-roughness", "must be a number from 0 to 1, or a file");
    return bake::BaseRoughness(value);
  }
  return bake::BaseRoughness(io::read_image(text));
}

void refuse_to_replace(const std::vector<std::string>& maps, const std::filesystem::path& output) {
  for (const std::string& map : maps) {
    std::error_code ignored; // what does not exist yet is no other file
    if (std::filesystem::equivalent(map, output, ignored))
      throw InputError(
          {.file = output, .problem = "would replace a map that is read", .remedy = "give another name"});
  }
}

void add_dither_option(CLI::App& verb, std::optional<bool>& dither, const std::string& when) {
  const std::map<std::string, bool> switches{{"on", true}, {"off", false}};
  verb.add_option("--dither", dither,
                  "on (default, " + when + ") or off: noise in place of terraces; flat texels stay flat")
      ->transform(one_of(switches))
      ->type_name("NAME")
      ->option_text("NAME");
}

void for_each_map(const std::vector<std::string>& maps, const Telling& telling,
                  const std::function<nlohmann::json(const std::string& map, Console& console)>& job) {
  Batch batch("maps", maps.size());
  nlohmann::json summaries = nlohmann::json::array();
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::string& map = maps[i];
    const auto failure = batch.run(map, [&] {
      Console console(fmt::format("{} {} of {}", telling.doing, i + 1, maps.size()), telling.quiet);
      if (maps.size() > 1)
        console.report().progress(static_cast<double>(i) / static_cast<double>(maps.size()));
      summaries.push_back(job(map, console));
    });
    if (failure) summaries.push_back({{"input", map}, {"error", failure->what}});
  }
  if (telling.json) {
    Console console("", true);
    if (maps.size() > 1)
      console.say_json({{"maps", summaries}});
    else if (!summaries[0].contains("error"))
      console.say_json(summaries[0]);
  }
  batch.finish();
}

} // namespace surfgrad::cli
