#include "msa/base/ending.h"

#include <filesystem>
#include <new>
#include <stdexcept>

#include "msa/base/error.h"

namespace deflect {

Ending ending_of(const std::exception_ptr& error) try { std::rethrow_exception(error); } catch (const InputError& e) {
  return {2, e.what()};
} catch (const ModelError& e) {
  return {3, e.what()};
} catch (const NumericalError& e) {
  return {4, e.what()};
} catch (const std::filesystem::filesystem_error& e) {
  const std::string path = e.path1().string();
  return {2, (path.empty() ? "the current folder" : path) + ": " + e.code().message()};
} catch (const std::bad_alloc&) {
  return {4, "out of memory"};
} catch (const std::exception& e) {
  return {70, e.what()};
} catch (...) {
  return {70, "an error without words"};
}

void throw_ending(const Ending& e) {
  if (e.code == 2) throw InputError(e.message);
  if (e.code == 3) throw ModelError(e.message);
  if (e.code == 4) throw NumericalError(e.message);
  throw std::runtime_error(e.message);
}

}  // namespace deflect
