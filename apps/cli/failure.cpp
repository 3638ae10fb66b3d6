#include "failure.hpp"

#include "batch.hpp"
#include "diagnostic/error.hpp"

#include <CLI/CLI.hpp>

#include <exception>
#include <new>

namespace surfgrad::cli {

Failure current_failure() {
  try {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const CLI::Error&) {
    throw;
  } catch (const SomeFailed& error) {
    return {error.status(), error.what()};
  } catch (const InputError& error) {
    return {input_is_wrong, error.what()};
  } catch (const MachineError& error) {
    return {machine_lacks_something, error.what()};
  } catch (const std::bad_alloc&) {
    return {machine_lacks_something, "not enough memory"};
  } catch (const std::exception& error) {
    return {machine_lacks_something, std::string("internal error: ") + error.what()};
  }
}

} // namespace surfgrad::cli
