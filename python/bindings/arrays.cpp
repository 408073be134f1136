// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace mmbrdf::python {

namespace {

std::string text(const std::vector<py::ssize_t>& shape) {
  std::string result = "(";
  for (std::size_t d = 0; d < shape.size(); ++d) result += (d > 0 ? ", " : "") + std::to_string(shape[d]);
  return result + (shape.size() == 1 ? ",)" : ")");
}

std::vector<py::ssize_t> shape_of(const Doubles& array) { return {array.shape(), array.shape() + array.ndim()}; }

/// The axes that broadcast. Throws unless the array ends in its core.
std::vector<py::ssize_t> outer_shape(const Operand& operand) {
  std::vector<py::ssize_t> shape = shape_of(operand.array);
  const auto axes = static_cast<py::ssize_t>(operand.core.size());
  if (static_cast<py::ssize_t>(shape.size()) < axes ||
      !std::equal(operand.core.begin(), operand.core.end(), shape.end() - axes))
    throw std::invalid_argument(std::string(operand.name) + ": its shape " + text(shape) + " does not end in " +
                                text(operand.core));
  shape.resize(shape.size() - operand.core.size());
  return shape;
}

/// Throws if the lengths differ and neither is 1.
void widen(std::vector<py::ssize_t>& shape, const std::vector<py::ssize_t>& other, const std::vector<Operand>& all) {
  if (other.size() > shape.size()) shape.insert(shape.begin(), other.size() - shape.size(), 1);
  for (std::size_t d = 0; d < other.size(); ++d) {
    py::ssize_t& length = shape[shape.size() - other.size() + d];
    if (length == 1) length = other[d];
    if (other[d] != 1 && other[d] != length) {
      std::string shapes;
      for (const Operand& operand : all)
        shapes += std::string(shapes.empty() ? "" : ", ") + operand.name + " " + text(shape_of(operand.array));
      throw std::invalid_argument("shapes do not broadcast: " + shapes);
    }
  }
}

/// A double that need not be aligned.
double loaded(const char* data) {
  double value;
  std::memcpy(&value, data, sizeof value);
  return value;
}

/// `count` numbers at this distance; returns where the next goes.
double* gather_numbers(const char* data, py::ssize_t stride, std::size_t count, double* out) {
  if (stride == static_cast<py::ssize_t>(sizeof(double)))
    std::memcpy(out, data, count * sizeof(double));
  else if (stride == 0)
    std::fill_n(out, count, loaded(data));
  else
    for (std::size_t i = 0; i < count; ++i, data += stride) out[i] = loaded(data);
  return out + count;
}

/// Angles in degrees of some directions: theta_i, phi_i, theta_r, phi_r.
using Angles = std::array<const double*, 4>;

/// Whether none needs to be unfolded or is invalid, as nearly always. Bits are gathered, since loops with comparisons
/// do not become loops of vectors: x − x has none unless x is not finite, θ (90 − θ) has a sign outside [0, 90].
bool plain(const Angles& angles, std::size_t count) {
  std::uint64_t none = 0, sign = 0;
  for (const std::size_t a : {0U, 1U, 2U, 3U})
    for (std::size_t i = 0; i < count; ++i) none |= std::bit_cast<std::uint64_t>(angles[a][i] - angles[a][i]);
  for (const std::size_t a : {0U, 2U})
    for (std::size_t i = 0; i < count; ++i) sign |= std::bit_cast<std::uint64_t>(angles[a][i] * (90 - angles[a][i]));
  return none == 0 && sign >> 63 == 0;
}

Geometry geometry_from(const Angles& angles, std::size_t i) {
  const Geometry result{direction_from_degrees(angles[0][i], angles[1][i]),
                        direction_from_degrees(angles[2][i], angles[3][i])};
  if (!std::isfinite(result.incident.phi)) throw std::invalid_argument("phi_i_deg is not finite");
  if (!std::isfinite(result.reflected.phi)) throw std::invalid_argument("phi_r_deg is not finite");
  return result;
}

/// In nested lists too, whose masks numpy forgets when it makes an array of them.
bool is_masked(const py::handle& given, const py::object& masked_array, int depth = 0) {
  constexpr int most = 32;  // axes that numpy has; a list may hold itself
  if (!PyList_Check(given.ptr()) && !PyTuple_Check(given.ptr()))
    return py::isinstance(given, masked_array) &&
           py::module_::import("numpy").attr("ma").attr("is_masked")(given).cast<bool>();
  for (py::ssize_t i = 0; depth < most && i < PySequence_Fast_GET_SIZE(given.ptr()); ++i) {
    PyObject* const one = PySequence_Fast_GET_ITEM(given.ptr(), i);
    if (!PyFloat_CheckExact(one) && is_masked(one, masked_array, depth + 1)) return true;
  }
  return false;
}

}  // namespace

void require_unmasked(const char* name, const Given& given) {
  if (is_masked(given, py::module_::import("numpy").attr("ma").attr("MaskedArray")))
    throw py::value_error(std::string(name) + ": a part of it is masked; leave it out");
}

Doubles doubles(const char* name, const Given& given) {
  const std::string argument = name;
  const py::module_ numpy = py::module_::import("numpy");
  if (given.is_none()) throw py::type_error(argument + ": None is not a number");
  require_unmasked(name, given);
  py::array array;
  try {
    array = numpy.attr("asarray")(given);
  } catch (const py::error_already_set&) {
    throw py::type_error(argument + ": expected a number or an array of numbers");
  }
  if (std::string("biuf").find(array.dtype().kind()) == std::string::npos)
    throw py::type_error(argument + ": expected real numbers, not " + std::string(py::str(array.dtype())));
  return Doubles(array);
}

std::vector<double> numbers(const char* name, const Given& given) {
  const Broadcast broadcast({{name, given}});
  std::vector<double> result(broadcast.size());
  broadcast.gather(0, 0, result.size(), result.data());
  return result;
}

py::array_t<double> array_of(const Mueller& matrix) {
  py::array_t<double> result({4, 4});
  Layout<Mueller>::store(matrix, result.mutable_data());
  return result;
}

py::array_t<double> array_of(const std::vector<Mueller>& matrices) {
  py::array_t<double> result({static_cast<py::ssize_t>(matrices.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < matrices.size(); ++i) Layout<Mueller>::store(matrices[i], result.mutable_data() + 16 * i);
  return result;
}

Broadcast::Broadcast(std::vector<Operand> operands) : operands_(std::move(operands)) {
  for (const Operand& operand : operands_) widen(shape_, outer_shape(operand), operands_);
  for (const py::ssize_t length : shape_) size_ *= static_cast<std::size_t>(length);
  for (const Operand& operand : operands_) {
    Source source{reinterpret_cast<const char*>(operand.array.data()), {}, {1, 1}, {0, 0}};
    const std::size_t axes = static_cast<std::size_t>(operand.array.ndim()) - operand.core.size();
    source.strides.assign(shape_.size(), 0);
    for (std::size_t d = 0; d < axes; ++d)
      if (operand.array.shape(static_cast<py::ssize_t>(d)) != 1)
        source.strides[shape_.size() - axes + d] = operand.array.strides(static_cast<py::ssize_t>(d));
    for (std::size_t d = 0; d < operand.core.size(); ++d) {
      const std::size_t axis = 2 - operand.core.size() + d;
      source.lengths[axis] = operand.core[d];
      source.core_strides[axis] = operand.array.strides(static_cast<py::ssize_t>(axes + d));
    }
    sources_.push_back(std::move(source));
  }
}

void Broadcast::gather(std::size_t which, std::size_t begin, std::size_t end, double* out) const {
  const Source& source = sources_[which];
  const std::size_t inner = shape_.empty() ? 1 : static_cast<std::size_t>(shape_.back());
  const py::ssize_t stride = shape_.empty() ? 0 : source.strides.back();
  while (begin < end) {
    std::size_t row = begin / inner;
    const char* data = source.data + static_cast<py::ssize_t>(begin % inner) * stride;
    for (std::size_t d = shape_.size(); d-- > 1;) {
      const auto length = static_cast<std::size_t>(shape_[d - 1]);
      data += static_cast<py::ssize_t>(row % length) * source.strides[d - 1];
      row /= length;
    }
    const std::size_t count = std::min(end - begin, inner - begin % inner);
    const auto [rows, columns] = source.lengths;
    if (rows == 1 && columns == 1) {
      out = gather_numbers(data, stride, count, out);
      begin += count;
      continue;
    }
    for (std::size_t i = 0; i < count; ++i, data += stride)
      for (py::ssize_t a = 0; a < rows; ++a)
        for (py::ssize_t b = 0; b < columns; ++b)
          *out++ = loaded(data + a * source.core_strides[0] + b * source.core_strides[1]);
    begin += count;
  }
}

const double* Broadcast::numbers(std::size_t which, std::size_t begin, std::size_t end, double* room) const {
  const Source& source = sources_[which];
  constexpr auto step = static_cast<py::ssize_t>(sizeof(double));
  const bool adjacent = shape_.size() == 1 && source.strides[0] == step &&
                        reinterpret_cast<std::uintptr_t>(source.data) % alignof(double) == 0;
  if (adjacent) {
    // Several arrays are read in turn, a little of each: the processor does not see what comes next.
    const double* const here = reinterpret_cast<const double*>(source.data) + begin;
    for (std::size_t i = begin + 512; i < std::min(end + 512, size_); i += 8) __builtin_prefetch(here + (i - begin));
    return here;
  }
  gather(which, begin, end, room);
  return room;
}

std::invalid_argument Broadcast::at_place(const std::invalid_argument& error, std::size_t position) const {
  if (size_ == 1) return error;
  std::string place = "]";
  for (std::size_t d = shape_.size(); d-- > 0;) {
    const auto length = static_cast<std::size_t>(shape_[d]);
    place = (d > 0 ? ", " : "[") + std::to_string(position % length) + place;
    position /= length;
  }
  return std::invalid_argument(error.what() + std::string(", at ") + place);
}

namespace {
thread_local int limit = 0;  // of threads that this one starts unless told otherwise; 0: none
}

int limit_threads(int most) { return std::exchange(limit, std::clamp(most, 0, most_threads)); }

void in_parts(std::size_t size, int threads, std::size_t least,
              const std::function<void(std::size_t, std::size_t)>& work) {
  if (threads < 0 || threads > most_threads)
    throw std::invalid_argument("threads = " + std::to_string(threads) + ", must be from 0 to " +
                                std::to_string(most_threads));
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const int asked = threads == 0 ? limit : threads;
  const std::size_t wanted = asked == 0 ? cores : static_cast<std::size_t>(asked);
  const std::size_t parts = std::clamp<std::size_t>(size / std::max<std::size_t>(least, 1), 1, wanted);
  std::vector<std::exception_ptr> errors(parts);
  const auto part = [&](std::size_t p) {
    try {
      work(size * p / parts, size * (p + 1) / parts);
    } catch (...) {
      errors[p] = std::current_exception();
    }
  };
  std::vector<std::jthread> others;
  others.reserve(parts);
  std::size_t next = 1;
  try {
    for (; next < parts; ++next) others.emplace_back(part, next);
  } catch (const std::exception&) {  // no more threads to be had, or no memory for one: this one does the rest
  }
  for (std::size_t p = next; p < parts; ++p) part(p);
  part(0);
  others.clear();  // all are done
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

std::vector<Operand> direction_operands(const Given& theta_i, const Given& phi_i, const Given& theta_r,
                                        const Given& phi_r) {
  return {{"theta_i_deg", theta_i}, {"phi_i_deg", phi_i}, {"theta_r_deg", theta_r}, {"phi_r_deg", phi_r}};
}

void gather(const Broadcast& broadcast, std::size_t first, std::size_t begin, std::size_t end, Geometry* out) {
  constexpr std::size_t some = 256;
  std::array<std::array<double, some>, 4> room;
  for (; begin < end; begin += some) {
    const std::size_t count = std::min(some, end - begin);
    Angles angles;
    for (std::size_t a = 0; a < 4; ++a) angles[a] = broadcast.numbers(first + a, begin, begin + count, room[a].data());
    if (plain(angles, count)) {  // what direction_from_degrees() does with these, without its questions
      for (std::size_t i = 0; i < count; ++i)
        out[i] = {{radians(angles[0][i]), radians(angles[1][i])}, {radians(angles[2][i]), radians(angles[3][i])}};
      out += count;
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      try {
        *out++ = geometry_from(angles, i);
      } catch (const std::invalid_argument& error) {
        throw broadcast.at_place(std::invalid_argument("direction " + std::string(error.what())), begin + i);
      }
    }
  }
}

Geometry geometry(const Broadcast& broadcast, std::size_t first, std::size_t position) {
  Geometry result;
  gather(broadcast, first, position, position + 1, &result);
  return result;
}

std::vector<Geometry> geometries(const Broadcast& broadcast, std::size_t first) {
  std::vector<Geometry> result(broadcast.size());
  gather(broadcast, first, 0, result.size(), result.data());
  return result;
}

}  // namespace mmbrdf::python
