// SPDX-License-Identifier: BSD-3-Clause
// numpy arrays of numbers, directions and Mueller matrices, broadcast against each other.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf::python {

namespace py = pybind11;

/// What was given for an argument that takes numbers or arrays of them; not looked at yet.
using Given = py::object;

using Doubles = py::array_t<double, py::array::forcecast>;

/// Throws ValueError, naming the argument, where something of it is masked, also within lists: it would count.
void require_unmasked(const char* name, const Given& given);

/// An array of real numbers, with the strides it has. Throws TypeError, naming the argument, for what is not made of
/// integers, floating-point numbers or truth values, and as require_unmasked() does.
Doubles doubles(const char* name, const Given& given);

/// A number, or an array of numbers, one behind the other.
std::vector<double> numbers(const char* name, const Given& given);

/// An argument: `core` are the lengths of its last axes, at most two, which do not broadcast. {4, 4} for matrices.
struct Operand {
  Operand(const char* its_name, const Given& given, std::vector<py::ssize_t> its_core = {})
      : name(its_name), array(doubles(its_name, given)), core(std::move(its_core)) {}
  const char* name;
  Doubles array;
  std::vector<py::ssize_t> core;
};

/// Several arrays as numpy broadcasts them. Reading needs no GIL.
class Broadcast {
 public:
  /// Throws std::invalid_argument, naming the arguments and their shapes, if they do not broadcast.
  explicit Broadcast(std::vector<Operand> operands);

  const std::vector<py::ssize_t>& shape() const { return shape_; }
  std::size_t size() const { return size_; }

  const Doubles& array(std::size_t which) const { return operands_[which].array; }

  /// How many numbers were given for one of the operands.
  std::size_t given(std::size_t which) const { return static_cast<std::size_t>(operands_[which].array.size()); }

  /// Copies what operand `which` has at the positions begin … end − 1 of the result (C order), core after core.
  void gather(std::size_t which, std::size_t begin, std::size_t end, double* out) const;

  /// The same for an operand of numbers: where they stand if they stand one behind the other, else copied to `room`.
  const double* numbers(std::size_t which, std::size_t begin, std::size_t end, double* room) const;

  /// The core at one position.
  template <std::size_t n>
  std::array<double, n> at(std::size_t which, std::size_t position) const {
    std::array<double, n> values;
    gather(which, position, position + 1, values.data());
    return values;
  }
  double number(std::size_t which, std::size_t position) const { return at<1>(which, position)[0]; }
  Mueller mueller(std::size_t which, std::size_t position) const { return {at<16>(which, position)}; }

  /// The error with its place: "…, at [2, 5]", counted from 0. As it is where there is but one.
  std::invalid_argument at_place(const std::invalid_argument& error, std::size_t position) const;

 private:
  struct Source {
    const char* data;
    std::vector<py::ssize_t> strides;
    std::array<py::ssize_t, 2> lengths, core_strides;  // of a core as rows and columns
  };
  std::vector<Operand> operands_;
  std::vector<Source> sources_;
  std::vector<py::ssize_t> shape_;
  std::size_t size_ = 1;
};

/// Calls work(begin, end) for parts of 0 … size − 1, on several threads if there is enough to do. `threads` 0: as many
/// as there are cores. The GIL must not be needed. Throws what the work throws; of several, that of the first part; and
/// std::invalid_argument unless 0 ≤ threads ≤ most_threads.
inline constexpr int most_threads = 1024;
void in_parts(std::size_t size, int threads, std::size_t least, const std::function<void(std::size_t, std::size_t)>&);

/// How many threads in_parts() takes for `threads` 0 when called by this thread, as where another program has a thread
/// on each core; 0: as many as there are cores. Returns what it was.
int limit_threads(int most);

/// Runs without the GIL.
template <class Work>
auto without_gil(Work work) {
  const py::gil_scoped_release release;
  return work();
}

/// How results of one position are laid out in an array.
template <class T>
struct Layout {
  using Scalar = T;
  static std::vector<py::ssize_t> core() { return {}; }
  static void store(const T& value, Scalar* out) { *out = value; }
};
template <class T, std::size_t n>
struct Layout<std::array<T, n>> {
  using Scalar = T;
  static std::vector<py::ssize_t> core() { return {n}; }
  static void store(const std::array<T, n>& values, Scalar* out) { std::copy(values.begin(), values.end(), out); }
};
template <>
struct Layout<Mueller> {
  using Scalar = double;
  static std::vector<py::ssize_t> core() { return {4, 4}; }
  static void store(const Mueller& m, double* out) { std::copy(m.elements.begin(), m.elements.end(), out); }
};

/// An array of the broadcast shape with `core` behind it.
template <class Scalar>
py::array_t<Scalar> new_array(const Broadcast& broadcast, const std::vector<py::ssize_t>& core) {
  std::vector<py::ssize_t> shape = broadcast.shape();
  shape.insert(shape.end(), core.begin(), core.end());
  return py::array_t<Scalar>(shape);
}

/// A number for an array without axes, as numpy's own functions return.
inline py::object unwrapped(const py::array& array) {
  return array.ndim() == 0 ? array.attr("__getitem__")(py::tuple()) : py::object(array);
}

/// Arrays (4, 4) and (n, 4, 4) of their own.
py::array_t<double> array_of(const Mueller& matrix);
py::array_t<double> array_of(const std::vector<Mueller>& matrices);

/// f(position) at each position, without the GIL, on all cores if there are many.
template <class F>
py::object map(const Broadcast& broadcast, F f) {
  using Result = std::invoke_result_t<F, std::size_t>;
  using Out = Layout<Result>;
  const std::vector<py::ssize_t> core = Out::core();
  auto result = new_array<typename Out::Scalar>(broadcast, core);
  std::size_t length = 1;
  for (const py::ssize_t n : core) length *= static_cast<std::size_t>(n);
  auto* const out = result.mutable_data();
  without_gil([&] {
    in_parts(broadcast.size(), 0, 2048, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        try {
          Out::store(f(i), out + i * length);
        } catch (const std::invalid_argument& error) {
          throw broadcast.at_place(error, i);
        }
      }
    });
  });
  return unwrapped(result);
}

/// f(Mueller) for an array of matrices, (…, 4, 4).
template <class F>
py::object over_matrices(const Given& mueller, F f) {
  const Broadcast broadcast({{"mueller", mueller, {4, 4}}});
  return map(broadcast, [&](std::size_t i) { return f(broadcast.mueller(0, i)); });
}

/// The last four operands of a question, from `first`: theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg.
std::vector<Operand> direction_operands(const Given& theta_i, const Given& phi_i, const Given& theta_r,
                                        const Given& phi_r);

/// Geometries of the positions begin … end − 1, whose angles in degrees are the operands from `first`. Throws
/// std::invalid_argument, with the place in the array, for invalid angles. And that of one position, and those of all.
void gather(const Broadcast& broadcast, std::size_t first, std::size_t begin, std::size_t end, Geometry* out);
Geometry geometry(const Broadcast& broadcast, std::size_t first, std::size_t position);
std::vector<Geometry> geometries(const Broadcast& broadcast, std::size_t first = 0);

}  // namespace mmbrdf::python
