#include <stdexcept>

#include "prepare/mesher/tasks.h"

namespace matstruct::mesher {

Answer resolve(const Request&) {
  throw std::runtime_error("todo");
}
Answer fill_holes(const Request&) {
  throw std::runtime_error("todo");
}
Answer wrap(const Request&) {
  throw std::runtime_error("todo");
}

}  // namespace matstruct::mesher
