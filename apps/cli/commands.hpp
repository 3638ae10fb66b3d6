#pragma once

#include <CLI/CLI.hpp>

namespace surfgrad::cli {

/// Each adds its verb to the program; the verb's callback does the job.
void add_render_command(CLI::App& program);
void add_bake_command(CLI::App& program);
void add_displace_command(CLI::App& program);
void add_gallery_command(CLI::App& program);
void add_shader_command(CLI::App& program);
void add_tangents_command(CLI::App& program);
void add_convert_command(CLI::App& program);
void add_inspect_command(CLI::App& program);
void add_blend_command(CLI::App& program);

} // namespace surfgrad::cli
