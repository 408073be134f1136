// SPDX-License-Identifier: BSD-3-Clause
// A model at many wavelengths and geometries.
#pragma once

#include <algorithm>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "bindings.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf::python {

/// Counts, in many threads, what lies outside the fitted range of a model, and says so in one warning.
class Range {
 public:
  explicit Range(const ModelObject& model)
      : model_(model),
        theta_i_max_(std::min(validity().theta_i_max.value_or(radians(90)), model.theta_of_all())),
        theta_r_max_(validity().theta_r_max.value_or(radians(90))) {}

  void count(double wavelength, const Geometry& geometry) { count(wavelength, std::span(&geometry, 1)); }

  void count(double wavelength, std::span<const Geometry> geometries) { count(std::span(&wavelength, 1), geometries); }

  /// One wavelength for all geometries, or for each.
  void count(std::span<const double> wavelengths, std::span<const Geometry> geometries) {
    bool beyond = false;
    for (const double w : wavelengths) beyond |= leaves_known_range(outside(validity(), w));
    for (const Geometry& g : geometries) beyond |= g.incident.theta > theta_i_max_ || g.reflected.theta > theta_r_max_;
    if (!beyond) return;  // as nearly always
    RangeCount here;
    for (std::size_t i = 0; i < geometries.size(); ++i)
      here.add(outside(validity(), wavelengths[wavelengths.size() == 1 ? 0 : i], geometries[i]));
    const std::lock_guard lock(mutex_);
    range_.add(here);
  }

  /// Of `size` questions, counted or not.
  void warn(std::size_t size) {
    range_.asked = static_cast<long>(size);
    warn_outside(model_, range_);
  }

 private:
  const Validity& validity() const { return model_.model().validity; }

  const ModelObject& model_;
  double theta_i_max_, theta_r_max_;
  std::mutex mutex_;
  RangeCount range_;
};

/// Geometries of one wavelength, next to each other in the order of the question.
struct Some {
  std::span<const Geometry> geometries;
  const std::size_t* positions;  // of each in the result; null: from `begin` on
  std::size_t begin;
  std::size_t position(std::size_t i) const { return positions ? positions[i] : begin + i; }
};

/// What a model is asked for: wavelengths and directions, broadcast.
class Question {
 public:
  Question(ModelObject& model, const std::optional<Given>& wavelength_nm, const Given& theta_i, const Given& phi_i,
           const Given& theta_r, const Given& phi_r, bool as_printed)
      : model_(model.shared_from_this()),
        as_printed_(as_printed),
        broadcast_(operands(*model_, wavelength_nm, theta_i, phi_i, theta_r, phi_r)),
        one_wavelength_(broadcast_.given(0) == 1) {}

  const Broadcast& broadcast() const { return broadcast_; }
  const ModelObject& object() const { return *model_; }
  const Model& model() const { return model_->turned(as_printed_); }
  PreparedModel prepared(double wavelength) const { return model_->prepared(wavelength, as_printed_); }

  /// use(prepared, some) with prepared = make(wavelength in micrometres), for all positions. Needs no GIL.
  template <class Make, class Use>
  void each(int threads, std::size_t least, Make make, Use use) const {
    if (broadcast_.size() == 0) return;
    if (one_wavelength_) {
      const auto prepared = make(valid_micrometres(broadcast_.number(0, 0)));
      in_parts(broadcast_.size(), threads, least,
               [&](std::size_t begin, std::size_t end) { run(begin, end, nullptr, prepared, use); });
      return;
    }
    const std::vector<double> wavelengths = all_wavelengths();
    std::vector<std::size_t> order(wavelengths.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return wavelengths[a] < wavelengths[b]; });
    in_parts(order.size(), threads, least, [&](std::size_t begin, std::size_t end) {
      for (std::size_t next = begin; begin < end; begin = next) {
        const double wavelength = wavelengths[order[begin]];
        while (next < end && wavelengths[order[next]] == wavelength) ++next;
        run(begin, next, order.data(), make(wavelength), use);
      }
    });
  }

  bool has_one_wavelength() const { return one_wavelength_; }

  /// use(prepared, wavelengths, geometries, begin) for the positions from `begin` on, of whatever wavelengths; prepared at
  /// one of them. Needs no GIL.
  template <class Use>
  void each_row(int threads, std::size_t least, Use use) const {
    if (broadcast_.size() == 0) return;
    const std::vector<double> wavelengths = all_wavelengths();
    const PreparedModel first = prepared(wavelengths.front());
    in_parts(wavelengths.size(), threads, least, [&](std::size_t begin, std::size_t end) {
      std::vector<Geometry> geometries(std::min(most, end - begin));
      for (; begin < end; begin += geometries.size()) {
        geometries.resize(std::min(most, end - begin));
        gather(broadcast_, 1, begin, begin + geometries.size(), geometries.data());
        use(first, std::span(wavelengths).subspan(begin, geometries.size()), geometries, begin);
      }
    });
  }

 private:
  static constexpr std::size_t most = 512;  // geometries and matrices stay in the first-level cache, or nearly

  static double valid_micrometres(double nanometres) {
    const double result = micrometres(nanometres);
    require_wavelength(result);
    return result;
  }

  /// Micrometres, at each position.
  std::vector<double> all_wavelengths() const {
    std::vector<double> wavelengths(broadcast_.size());
    broadcast_.gather(0, 0, wavelengths.size(), wavelengths.data());
    for (std::size_t i = 0; i < wavelengths.size(); ++i) {
      try {
        wavelengths[i] = valid_micrometres(wavelengths[i]);
      } catch (const std::invalid_argument& error) {
        throw broadcast_.at_place(error, i);
      }
    }
    return wavelengths;
  }

  static std::vector<Operand> operands(const ModelObject& model, const std::optional<Given>& wavelength_nm,
                                       const Given& theta_i, const Given& phi_i, const Given& theta_r,
                                       const Given& phi_r) {
    std::vector<Operand> result = direction_operands(theta_i, phi_i, theta_r, phi_r);
    result.insert(result.begin(), model.wavelength_operand(wavelength_nm));
    return result;
  }

  template <class Prepared, class Use>
  void run(std::size_t begin, std::size_t end, const std::size_t* order, const Prepared& prepared, Use use) const {
    std::vector<Geometry> geometries(std::min(most, end - begin));
    for (; begin < end; begin += geometries.size()) {
      const std::size_t count = std::min(geometries.size(), end - begin);
      if (order == nullptr)
        gather(broadcast_, 1, begin, begin + count, geometries.data());
      else
        for (std::size_t i = 0; i < count; ++i) geometries[i] = geometry(broadcast_, 1, order[begin + i]);
      use(prepared, Some{{geometries.data(), count}, order ? order + begin : nullptr, begin});
    }
  }

  ModelPointer model_;
  bool as_printed_;
  Broadcast broadcast_;
  bool one_wavelength_;
};

/// Declares a method that has the arguments of a question before its own.
template <class Function, class... Arguments>
void define(ModelClass& c, const char* name, Function function, const char* doc, const Arguments&... own) {
  c.def(name, function, py::arg("wavelength_nm") = py::none(), py::arg("theta_i_deg"), py::arg("phi_i_deg"),
        py::arg("theta_r_deg"), py::arg("phi_r_deg"), py::kw_only(), own..., doc);
}

using Wavelength = std::optional<Given>;
using Threads = std::optional<int>;

/// {"scale": 0.003, "theta_i_deg": 0.02}: names as in the program's --term, angles with their unit.
using Terms = std::optional<std::map<std::string, double>>;
std::vector<TypeBTerm> terms_from(const Terms& named);

}  // namespace mmbrdf::python
