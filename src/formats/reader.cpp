// SPDX-License-Identifier: BSD-3-Clause
#include "formats/reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double largest_value = 1e100;  // as tables of samples have it: squares and sums stay finite

}  // namespace

std::runtime_error Source::error(const std::string& what) const { return std::runtime_error(path + ": " + what); }

std::vector<double> Source::told_wavelengths(std::size_t count, const std::string& values) const {
  const std::vector<double>& told = options.wavelengths;
  const std::string how = options.told_by + (count == 1 ? "NM" : "NM,NM ..., one for each");
  if (told.empty()) throw error("does not say the wavelength of its " + values + ": tell it, " + how);
  if (told.size() != count)
    throw error("has " + values + ", not " + std::to_string(told.size()) + ": " + how + ", not " +
                nanometre_text(told));
  for (const double wavelength : told) require_wavelength(wavelength, path + ": the wavelength told");
  return told;
}

void Source::require_none_told() const {
  if (!options.wavelengths.empty())
    throw error("says its wavelengths itself: leave out " + options.told_by + nanometre_text(options.wavelengths));
}

void SampleSink::add(const Sample& sample) {
  const auto beyond = [](double value) { return std::abs(value) > largest_value; };
  if (std::isnan(sample.f11) || beyond(sample.f11) || std::ranges::any_of(sample.normalized.elements, beyond) ||
      std::ranges::any_of(sample.uncertainty.elements, beyond))
    return not_measured();
  if (!above_horizon(sample.geometry)) return below_horizon();
  waiting_.push_back(sample);
  ++samples_;
  if (waiting_.size() < some) return;
  use_(waiting_);
  waiting_.clear();
}

void SampleSink::finish(const std::string& path) {
  if (!waiting_.empty()) use_(waiting_);
  waiting_.clear();
  if (samples_ > 0) return;
  const std::uint64_t others = below_ + empty_;
  throw std::runtime_error(path + (others == 0 ? ": no samples" : ": no samples above the horizon") +
                           (empty_ > 0 ? " that were measured" : ""));
}

std::string SampleSink::passed_over(const std::string& rows) const {
  const std::string of = " of " + std::to_string(samples_ + below_ + empty_) + " " + rows + " ";
  std::string text;
  if (below_ > 0) text += "; " + std::to_string(below_) + of + "at or below the horizon passed over";
  if (empty_ > 0) text += "; " + std::to_string(empty_) + of + "not measured, passed over";
  return text;
}

Sample scalar_sample(double wavelength, const Geometry& geometry, double f11) {
  Sample sample{.wavelength = wavelength, .geometry = geometry, .f11 = f11, .normalized = {}};
  sample.normalized.elements.fill(std::numeric_limits<double>::quiet_NaN());
  sample.normalized(0, 0) = 1;
  return sample;
}

bool above_horizon(const Geometry& geometry) {
  constexpr double most = std::numbers::pi / 2 - horizon;
  return geometry.incident.theta < most && geometry.reflected.theta < most;
}

std::string nanometre_text(std::span<const double> wavelengths) {
  std::string text;
  for (std::size_t i = 0; i < wavelengths.size(); ++i)
    text += (i == 0 ? "" : i + 1 == wavelengths.size() ? " and " : ", ") + shortest(in_nanometres(wavelengths[i]));
  return text + " nm";
}

void require_wavelength(double wavelength, const std::string& where) {
  constexpr double shortest_one = 0.01, longest_one = 1000;
  if (!(wavelength >= shortest_one && wavelength <= longest_one))
    throw std::runtime_error(where + ": " + shortest(in_nanometres(wavelength)) +
                             " nm is no wavelength in [10, 1000000] nm; is it in another unit?");
}

}  // namespace mmbrdf
