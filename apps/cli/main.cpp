#include "batch.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "device.hpp"
#include "diagnostic/error.hpp"
#include "failure.hpp"
#include "interrupt.hpp"

#include <iostream>
#include <string>

namespace {

using surfgrad::cli::machine_lacks_something;
using surfgrad::cli::usage_is_wrong;

int failed(int status, std::string_view what) {
  surfgrad::cli::complain(what);
  return status;
}

/// Help, the version, or what is wrong with the command line.
int explain(const CLI::App& program, const CLI::ParseError& error) {
  if (program.exit(error) != 0) return usage_is_wrong;
  if (!std::cout.flush()) return failed(machine_lacks_something, "standard output: cannot write");
  return 0;
}

int run(CLI::App& program, int argc, char** argv) {
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return explain(program, error);
  } catch (const surfgrad::cli::SomeFailed& error) {
    for (const std::string& line : error.lines()) surfgrad::cli::complain(line);
    return error.status();
  } catch (const surfgrad::Cancelled&) {
    return machine_lacks_something; // main ends the program by the signal that asked for it
  } catch (...) {
    const surfgrad::cli::Failure failure = surfgrad::cli::current_failure();
    return failed(failure.status, failure.what);
  }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App program("surfgrad composites bump maps correctly: any source, any UV set, any surface.",
                   "surfgrad");
  program.set_version_flag("--version", "surfgrad " SURFGRAD_VERSION);
  program.require_subcommand(1);
  program.footer("surfgrad VERB --help explains a verb.\n"
                 "Exit status: 0 done, 1 the input is wrong, 2 usage, 3 the machine lacks something\n"
                 "or an internal error. An interrupt leaves either the whole output or none.");
  surfgrad::cli::add_device_list(program);
  surfgrad::cli::add_render_command(program);
  surfgrad::cli::add_bake_command(program);
  surfgrad::cli::add_displace_command(program);
  surfgrad::cli::add_gallery_command(program);
  surfgrad::cli::add_shader_command(program);
  surfgrad::cli::add_tangents_command(program);
  surfgrad::cli::add_convert_command(program);
  surfgrad::cli::add_blend_command(program);
  surfgrad::cli::add_inspect_command(program);
  surfgrad::cli::note_interrupts();
  const int status = run(program, argc, argv);
  if (surfgrad::cli::interrupted()) surfgrad::cli::end_by_interrupt();
  return status;
}
