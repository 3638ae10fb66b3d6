#include "commands.hpp"
#include "diagnostic/error.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

// Exit statuses, the same for every verb.
constexpr int input_is_wrong = 1;
constexpr int usage_is_wrong = 2;
constexpr int machine_lacks_something = 3;

int complain(int status, const char* what) {
  fmt::print(stderr, "surfgrad: {}\n", what);
  return status;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App program("surfgrad composites bump maps correctly: any source, any UV set, any surface.",
                   "surfgrad");
  program.set_version_flag("--version", "surfgrad " SURFGRAD_VERSION);
  program.require_subcommand(1);
  program.footer("surfgrad VERB --help explains a verb.\n"
                 "Exit status: 0 done, 1 the input is wrong, 2 usage, 3 the machine lacks something.");
  surfgrad::cli::add_render_command(program);
  surfgrad::cli::add_bake_command(program);
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : usage_is_wrong;
  } catch (const surfgrad::InputError& error) {
    return complain(input_is_wrong, error.what());
  } catch (const surfgrad::MachineError& error) {
    return complain(machine_lacks_something, error.what());
  } catch (const std::bad_alloc&) {
    return complain(machine_lacks_something, "not enough memory");
  } catch (const std::exception& error) {
    return complain(machine_lacks_something, error.what());
  }
}
