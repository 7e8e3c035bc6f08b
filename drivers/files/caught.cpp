#include "drivers/files/caught.h"

#include <exception>
#include <new>

namespace framewatch::drivers {

std::string caught(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const std::bad_alloc&) {
    return "there is not enough memory";
  } catch (const std::exception& error) {
    return *error.what() != 0 ? error.what() : "an exception without a text";
  } catch (...) {
    return "an exception of an unknown kind";
  }
}

}  // namespace framewatch::drivers
