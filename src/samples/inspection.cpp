// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/inspection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double impossible = 10, bright = 1e4, dark = 10;  // fill values
constexpr double beyond_one = 1.5, not_realizable = 0.1;
constexpr double few = 0.01, many = 0.2;  // parts of all samples
constexpr std::ptrdiff_t fewest = 3;      // samples that are no chance
constexpr double shortest_wavelength = 0.1, longest_wavelength = 20;

/// f11 and the divided elements that are there.
std::vector<double> known_values(const Sample& sample) {
  std::vector<double> values;
  const Elements missing = not_measured(sample);
  for (std::size_t e = 0; e < 16; ++e)
    if (!missing[e]) values.push_back(e == 0 ? sample.f11 : sample.normalized.elements[e]);
  return values;
}

double largest_element(const Sample& sample) {
  double largest = 0;
  for (std::size_t e = 1; e < 16; ++e)
    if (const double size = std::abs(sample.normalized.elements[e]); size > largest) largest = size;
  return largest;
}

/// The numbers of samples, as findings name them.
class Named {
 public:
  explicit Named(std::span<const long> numbers) : numbers_(numbers) {}

  /// "20 samples: 3, 17, 18, 21, 30, …"
  std::string operator()(const std::vector<std::size_t>& which) const {
    constexpr std::size_t most = 8;
    std::string text = std::to_string(which.size()) + (which.size() == 1 ? " sample: " : " samples: ");
    for (std::size_t i = 0; i < std::min(which.size(), most); ++i)
      text +=
          (i > 0 ? ", " : "") + std::to_string(numbers_.empty() ? static_cast<long>(which[i]) + 1 : numbers_[which[i]]);
    return text + (which.size() > most ? ", ..." : "");
  }

 private:
  std::span<const long> numbers_;
};

/// Those for which it holds.
template <class Predicate>
std::vector<std::size_t> which_are(std::span<const Sample> samples, Predicate is_it) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (is_it(samples[i])) result.push_back(i);
  return result;
}

bool are_many(const std::vector<std::size_t>& which, std::size_t of) {
  return std::ssize(which) >= fewest && static_cast<double>(which.size()) > few * static_cast<double>(of);
}

std::string zeros(std::span<const Sample> samples) {
  constexpr std::size_t enough = 4;
  std::string list;
  for (std::size_t e = 1; e < 16 && samples.size() >= enough; ++e)
    if (std::ranges::all_of(samples, [&](const Sample& s) { return s.normalized.elements[e] == 0; }))
      list += (list.empty() ? "" : ", ") + sample_element(e);
  return list;
}

/// All numbers of a sample; NaN, which no order has, as what no measurement is.
std::array<double, 38> numbers_of(const Sample& given) {
  const Sample s = in_own_frame(given);
  std::array<double, 38> result{s.wavelength, s.geometry.incident.theta, s.geometry.incident.phi,
                                s.geometry.reflected.theta, s.geometry.reflected.phi};
  std::ranges::copy(s.normalized.elements, result.begin() + 5);
  result[5] = s.f11;  // in place of element 11, which is 1
  std::ranges::copy(s.uncertainty.elements, result.begin() + 21);
  result[37] = static_cast<double>(own_frame(given));
  for (double& number : result)
    if (std::isnan(number)) number = 1e300;
  return result;
}

std::vector<std::size_t> repeated(std::span<const Sample> samples) {
  std::vector<std::size_t> result;
  std::map<std::array<double, 38>, std::size_t> seen;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (!seen.emplace(numbers_of(samples[i]), i).second) result.push_back(i);
  return result;
}

}  // namespace

std::string to_string(const Finding& finding) {
  const char* then = finding.evidence.ends_with('?') ? " " : ": ";
  return finding.fault + ": " + finding.evidence + (finding.remedy.empty() ? "" : then + finding.remedy);
}

namespace {

/// The median of |f11| of those that are known and not 0; 0 if there are none.
double typical_f11(std::span<const Sample> samples) {
  std::vector<double> values;
  for (const Sample& sample : samples)
    if (sample.f11 != 0 && !std::isnan(sample.f11)) values.push_back(std::abs(sample.f11));
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Whether samples may be bright there: around the direction of a mirror, or back to the source.
bool may_be_peak(const Geometry& geometry) {
  constexpr double around = 20;  // degrees
  const auto& [incident, reflected] = geometry;
  const double along = std::cos(incident.theta) * std::cos(reflected.theta),
               across = std::sin(incident.theta) * std::sin(reflected.theta) * std::cos(reflected.phi - incident.phi);
  return along + std::abs(across) > std::cos(radians(around));
}

/// The smallest distance of different numbers; infinite if there is one alone. They are sorted.
double step_of(std::span<const double> values) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) step = std::min(step, values[i] - values[i - 1]);
  return step;
}

/// The numbers that stand in place of f11, as they show by standing alone.
std::vector<double> repeated_f11(std::span<const Sample> samples, double typical) {
  constexpr double apart = 0.1, outstanding = 5, steps = 2.5;
  std::vector<double> values, result;
  for (const Sample& sample : samples)
    if (!std::isnan(sample.f11)) values.push_back(sample.f11);
  std::ranges::sort(values);
  if (values.empty() || values.front() == values.back()) return result;
  const double lowest = values.front(), highest = values.back();
  const auto next = std::upper_bound(values.begin(), values.end(), lowest),
             top = std::lower_bound(values.begin(), values.end(), highest);
  const double rounding = step_of({next, values.end()});
  if (lowest <= 0 && *next > 0 && next - values.begin() >= fewest && (lowest < 0 || *next > apart * typical) &&
      (std::isinf(rounding) || *next - lowest > steps * rounding))
    result.push_back(lowest);
  const auto elsewhere = [&](const Sample& s) { return s.f11 == highest && !may_be_peak(s.geometry); };
  if (const double before = *std::prev(top); values.end() - top >= fewest && before > 0 &&
                                             highest > outstanding * before && std::ranges::any_of(samples, elsewhere))
    result.push_back(highest);
  return result;
}

}  // namespace

FillValues::FillValues(std::span<const Sample> samples)
    : typical_(typical_f11(samples)), repeated_(repeated_f11(samples, typical_)) {}

bool FillValues::include(const Sample& one) const {
  const Sample sample = in_own_frame(one);
  const std::vector<double> values = known_values(sample);
  if (values.size() > 1 && std::ranges::all_of(values, [&](double value) { return value == values.front(); }))
    return true;
  return largest_element(sample) > impossible || std::ranges::find(repeated_, sample.f11) != repeated_.end() ||
         (typical_ > 0 &&
          ((sample.f11 > bright * typical_ && !may_be_peak(sample.geometry)) || sample.f11 < -dark * typical_));
}

namespace {

/// Where most are: the rest is a few dark ones with noise.
std::vector<std::size_t> not_positive(std::span<const Sample> samples, const FillValues& fill_values) {
  auto which = which_are(samples, [&](const Sample& s) { return s.f11 <= 0 && !fill_values.include(s); });
  if (2 * which.size() <= samples.size()) which.clear();
  return which;
}

}  // namespace

std::vector<Finding> row_findings(std::span<const Sample> given, std::span<const long> numbers) {
  require_valid(given);
  std::vector<Sample> samples;
  std::ranges::transform(given, std::back_inserter(samples), in_own_frame);
  const Named named(numbers);
  const FillValues fill_values(samples);
  std::vector<Finding> result;
  // Large elements are fill values in few samples; in many they are in another unit.
  const auto has_large_elements = [&](const Sample& s) {
    Sample f11_alone = s;
    for (std::size_t e = 1; e < 16; ++e)
      f11_alone.normalized.elements[e] = s.normalized.elements[e] == s.f11 ? s.f11 : 0;
    return largest_element(s) > beyond_one && !fill_values.include(f11_alone);
  };
  const bool all_wrong = static_cast<double>(std::ranges::count_if(samples, has_large_elements)) >
                         many * static_cast<double>(samples.size());
  const auto fills = which_are(
      samples, [&](const Sample& s) { return fill_values.include(s) && !(all_wrong && has_large_elements(s)); });
  if (!fills.empty()) {
    const Sample& first = samples[fills.front()];
    const std::string example = std::abs(largest_element(first)) > impossible && !(std::abs(first.f11) > impossible)
                                    ? "elements up to " + rounded(largest_element(first), 4)
                                    : "f11 = " + (std::isnan(first.f11) ? "" : rounded(first.f11, 6));
    result.push_back({"fill values", example + " in " + named(fills), "leave these rows out", fills});
  }
  if (const auto dark_ones = not_positive(samples, fill_values); !dark_ones.empty())
    result.push_back({"f11 not positive", "in " + named(dark_ones),
                      "was a background subtracted twice, or is it another column?", dark_ones});
  const auto beyond = which_are(samples, [&](const Sample& s) {
    return largest_element(s) > beyond_one && (all_wrong || !fill_values.include(s));
  });
  if (are_many(beyond, samples.size()))
    result.push_back({"elements not divided", "elements beyond " + rounded(beyond_one, 2) + " in " + named(beyond),
                      "are they divided by f11, and in no percent? m12 ... m44 are M12 / M11 ...", beyond});
  const auto impossible_ones = which_are(samples, [&](const Sample& s) {
    return s.f11 >= fill_values.typical() && !fill_values.include(s) && not_measured(s).none() &&
           largest_element(s) <= beyond_one && realizability_margin(s.normalized) < -not_realizable;
  });
  if (are_many(impossible_ones, samples.size()))
    result.push_back({"matrices that cannot exist",
                      "the smallest coherency eigenvalue is below " + rounded(-not_realizable, 2) + " of f11 in " +
                          named(impossible_ones),
                      "are columns exchanged, or signs of single elements wrong?", impossible_ones});
  if (const std::string list = zeros(samples); !list.empty())
    result.push_back({"zeros",
                      "exactly 0 in all samples: " + list,
                      "leave out the columns of what was not measured, so that it is unknown and not 0",
                      {}});
  if (const auto again = repeated(given); !again.empty())
    result.push_back({"repeated rows", "the same in every number as an earlier one: " + named(again),
                      "leave them out: a reading counts once", again});
  const auto far = which_are(
      samples, [](const Sample& s) { return s.wavelength < shortest_wavelength || s.wavelength > longest_wavelength; });
  if (!far.empty())
    result.push_back({"wavelengths", shortest(in_nanometres(samples[far.front()].wavelength)) + " nm in " + named(far),
                      "is the unit nanometres (wavelength_nm) or micrometres (wavelength_um)?", far});
  return result;
}

}  // namespace mmbrdf
