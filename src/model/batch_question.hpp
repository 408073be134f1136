// SPDX-License-Identifier: BSD-3-Clause
/// What a batch asks of the kernel.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mmbrdf/model/batch.hpp"
#include "model/kernel/plan.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

/// A model with its coefficients in the precision asked for, in the frame of the options.
template <class T>
class BatchQuestion {
 public:
  BatchQuestion(const PreparedIncidence& prepared, Frame asked)
      : frame(asked), unknown(Evaluation::pattern(prepared).unknown) {
    convert(Evaluation::model(prepared));
  }

  /// At the wavelengths of the options, if there are any. What is of one is folded once, with the same bits; not so in single
  /// precision, where a point would have others than among points of other wavelengths.
  BatchQuestion(const PreparedModel& prepared, std::size_t count, const BatchOptions& options)
      : frame(options.frame), unknown(Evaluation::pattern(prepared).unknown), wavelengths(options.wavelengths) {
    if (wavelengths.empty()) {
      convert(Evaluation::model(prepared));
      return;
    }
    if (count != wavelengths.size())
      throw std::invalid_argument(std::to_string(count) + " geometries, " + std::to_string(wavelengths.size()) +
                                  " wavelengths");
    for (const double wavelength : wavelengths) require_wavelength(wavelength);
    const bool are_one = std::ranges::adjacent_find(wavelengths, std::ranges::not_equal_to()) == wavelengths.end();
    if (std::is_same_v<T, double> && are_one) {
      folded_ = prepared.at(std::exchange(wavelengths, {}).front());
      convert(Evaluation::model(*folded_));
    } else {
      convert_all_powers(prepared);
    }
  }
  /// The same at the wavelength of point q alone.
  BatchQuestion(const BatchQuestion& all, std::size_t q)
      : model(all.model),
        frame(all.frame),
        unknown(all.unknown),
        wavelengths(all.reflectance ? all.wavelengths.subspan(q, 1) : all.wavelengths),
        reflectance(all.reflectance) {}
  BatchQuestion(const BatchQuestion&) = delete;
  BatchQuestion& operator=(const BatchQuestion&) = delete;

  KernelModel<T> model{};
  Frame frame;
  Elements unknown;  // in the frame xy
  std::span<const double> wavelengths;
  const ReflectanceTable* reflectance = nullptr;

 private:
  /// At each of the wavelengths: `all` has the coefficients of λ⁰, then those of λ¹, …
  void require_finite_sums(std::span<const double> all, std::size_t powers) const {
    const double longest = *std::max_element(wavelengths.begin(), wavelengths.end());
    const std::size_t count = all.size() / powers;
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0, power = 1;
      for (std::size_t p = 0; p < powers; ++p, power *= longest) sum += std::abs(all[p * count + i]) * power;
      largest = std::max(largest, sum);
    }
    for (const double value : reflectance->values) largest = std::max(largest, std::abs(value));
    if (!(largest <= static_cast<double>(std::numeric_limits<T>::max())))
      throw std::invalid_argument("wavelength " + shortest(in_nanometres(longest)) + " nm: its powers are too large");
  }

  void convert_all_powers(const PreparedModel& prepared) {
    const PreparedPattern& pattern = Evaluation::pattern(prepared);
    reflectance = &pattern.reflectance;
    require_finite_sums(pattern.form_by_powers, static_cast<std::size_t>(pattern.powers) + 1);
    KernelModel<double> asked = Evaluation::model(prepared);
    asked.powers = pattern.powers;
    asked.coefficients = pattern.form_by_powers.data();
    convert(asked);
  }

  void convert(const KernelModel<double>& from) {
    model = {from.form,
             from.projected,
             from.turned,
             kernel_frame(frame),
             {static_cast<T>(from.turned_by[0]), static_cast<T>(from.turned_by[1])},
             {},
             from.list,
             nullptr,
             from.powers,
             from.count,
             static_cast<T>(from.scale)};
    for (std::size_t j = 0; j < 5; ++j) model.incident[j] = static_cast<T>(from.incident[j]);
    if constexpr (std::is_same_v<T, double>) {
      model.coefficients = from.coefficients;
    } else {
      own_.resize(static_cast<std::size_t>((from.powers + 1) * from.count));
      for (std::size_t i = 0; i < own_.size(); ++i) own_[i] = static_cast<T>(from.coefficients[i]);
      if (!std::all_of(own_.begin(), own_.end(), [](T a) { return std::isfinite(a); }) || !std::isfinite(model.scale))
        throw std::invalid_argument("a coefficient is too large for single precision");
      model.coefficients = own_.data();
    }
  }
  std::vector<T> own_;
  std::optional<PreparedModel> folded_;
};

}  // namespace mmbrdf
