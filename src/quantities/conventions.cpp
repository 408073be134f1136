// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/conventions.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Signs = std::array<int, 4>;

/// How the matrix that was given becomes the one that is tried.
struct Convention {
  const char *name, *remedy;
  std::optional<Frame> frame = {};  ///< in which it is read; none: in which it was given
  Signs scattered{1, 1, 1, 1}, incident{1, 1, 1, 1};
  bool transposed = false, arms_exchanged = false;
};

constexpr Signs s2{1, -1, 1, 1}, s3{1, 1, -1, 1}, s4{1, 1, 1, -1}, s2_s3{1, -1, -1, 1}, s3_s4{1, 1, -1, -1};
constexpr const char *exchanged_s_p = "were s and p exchanged there?", *dial = "does a dial there turn the other way?",
                     *turned_axes = "were s and p exchanged there, and +45 and -45 degrees?",
                     *handedness = "is left right in one of them?";

constexpr std::array readings{
    Convention{"frame xy", "--frame xy", Frame::xy}, Convention{"frame sp", "--frame sp", Frame::sp},
    Convention{"frame scattering_plane", "--frame scattering_plane", Frame::scattering_plane}};
constexpr Convention row_by_row{"the frames of the rows", ""};

constexpr Convention mirrored_in_xy{
    .name = "S3 of both beams reversed, azimuths counted the other way, or transposed",
    .remedy = "multiply phi_i and phi_r by -1, exchange m12 and m21, m13 and m31 ..., or change the signs",
    .scattered = s3,
    .incident = s3};
/// In frames that turn with the beams these are three faults; in xy they are one, and no fit could tell the last.
constexpr std::array where_frames_turn{
    Convention{.name = "S3 of both beams reversed, or azimuths counted the other way",
               .remedy = "multiply phi_i and phi_r by -1, or change the signs",
               .scattered = s3,
               .incident = s3},
    Convention{.name = "transposed",
               .remedy = "exchange m12 and m21, m13 and m31 ... or f_sp and f_ps (--columns m12=m21,m21=m12,...)",
               .transposed = true},
    Convention{.name = "arms exchanged",
               .remedy = "exchange theta_i and theta_r, phi_i and phi_r (--columns theta_i_deg=THETA_R,...)",
               .arms_exchanged = true}};

constexpr std::array signs_of_beams{
    Convention{.name = "S2 of the source reversed", .remedy = exchanged_s_p, .incident = s2},
    Convention{.name = "S2 of the receiver reversed", .remedy = exchanged_s_p, .scattered = s2},
    Convention{.name = "S3 of the source reversed", .remedy = dial, .incident = s3},
    Convention{.name = "S3 of the receiver reversed", .remedy = dial, .scattered = s3},
    Convention{.name = "S4 of one beam reversed", .remedy = handedness, .incident = s4},
    Convention{.name = "S3 and S4 of the source reversed", .remedy = dial, .incident = s3_s4},
    Convention{.name = "S3 and S4 of the receiver reversed", .remedy = dial, .scattered = s3_s4},
    Convention{.name = "axes of one beam turned by 90 degrees", .remedy = turned_axes, .incident = s2_s3}};

constexpr Elements off_diagonal{0x7bde};

/// The elements of these whose signs change.
Elements reversed(const Convention& convention, const Elements& measured) {
  Elements result;
  for (std::size_t e = 0; e < 16; ++e)
    result[e] = measured[e] && convention.scattered[e / 4] * convention.incident[e % 4] < 0;
  return result;
}

Sample read_as(const Convention& convention, const Sample& sample) {
  Sample given = in_frame(sample, sample.given_in);
  given.uncertainty = {};
  const Elements change = reversed(convention, Elements{}.set());
  for (std::size_t e = 0; e < 16; ++e)
    if (change[e]) given.normalized.elements[e] = -given.normalized.elements[e];
  if (convention.transposed) given.normalized = transpose(given.normalized);
  if (convention.arms_exchanged) given.geometry = exchanged(given.geometry);
  return from_frame(given, convention.frame.value_or(sample.given_in));
}

std::string remedy(const Convention& convention, const Elements& measured) {
  const std::string text = convention.remedy;
  const Elements change = reversed(convention, measured);
  if (change.none()) return text;
  return text + (text.ends_with('?') ? " Change the signs of " : " of ") + element_names(change);
}

/// As the samples were given first; of those that are the same of what was measured, one.
std::vector<Convention> conventions(std::span<const Sample> samples) {
  const Frame first = samples.front().given_in;
  const auto is_first = [&](const Sample& s) { return s.given_in == first; };
  const bool one = std::ranges::all_of(samples, is_first), turn = !one || first != Frame::xy;
  const Elements measured = measured_elements(samples);
  std::vector<Convention> result{one ? readings[static_cast<std::size_t>(first)] : row_by_row};
  std::vector<Elements> seen{{}};
  for (const Convention& reading : readings)
    if (!one || reading.frame != first) result.push_back(reading);
  const auto add = [&](const Convention& convention) {
    const Elements change = reversed(convention, measured);
    const bool other = convention.transposed ? (measured & off_diagonal).any() : convention.arms_exchanged;
    if (!other && std::ranges::find(seen, change) != seen.end()) return;
    if (!other) seen.push_back(change);
    result.push_back(convention);
  };
  if (turn)
    std::ranges::for_each(where_frames_turn, add);
  else
    add(mirrored_in_xy);
  std::ranges::for_each(signs_of_beams, add);
  return result;
}

/// Evenly spread, of the wavelength of the first.
std::vector<Sample> some_of(std::span<const Sample> samples, std::size_t most) {
  std::vector<Sample> here;
  std::ranges::copy_if(samples, std::back_inserter(here),
                       [&](const Sample& s) { return same_wavelength(s.wavelength, samples.front().wavelength); });
  const std::size_t count = std::min(here.size(), most);
  for (std::size_t i = 0; i < count; ++i) here[i] = here[i * here.size() / count];
  here.resize(count);
  return here;
}

long rows_of_others(const FitResult& fitted) {
  long rows = 0;
  for (std::size_t e = 1; e < 16; ++e) rows += fitted.elements[e].rows;
  return rows;
}

}  // namespace

std::vector<ConventionFit> convention_fits(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping,
                                           std::size_t most) {
  const std::vector<Sample> some = some_of(samples, most);
  const Elements measured = measured_elements(some);
  FitOptions options;
  options.minimum_norm = true;
  std::vector<ConventionFit> result;
  long rows = 0;
  for (const Convention& convention : conventions(some)) {
    std::vector<Sample> read;
    for (const Sample& sample : some) read.push_back(read_as(convention, sample));
    FitAccumulator accumulator({Family::isotropic, {0, orders.other}, mapping});
    accumulator.add(read);
    const FitResult fitted = accumulator.solve(options);
    if (result.empty()) rows = rows_of_others(fitted);
    if (rows == 0) return {};
    if (rows_of_others(fitted) == rows)  // else a part of the samples says nothing so, and cannot be compared
      result.push_back({convention.name, remedy(convention, measured), polarization_rms(fitted)});
  }
  result.front().read_as += ", as declared";
  return result;
}

Finding convention_finding(std::span<const ConventionFit> fits) {
  constexpr double rounding = 1e-9;  // of simulated data without noise
  const auto best = std::ranges::min_element(fits, {}, &ConventionFit::rms);
  if (best == fits.end() || !(fits.front().rms > better_convention * std::max(best->rms, rounding))) return {};
  return {convention_fault,
          "read as " + best->read_as + " the residuals would be " + rounded(best->rms, 3) + " instead of " +
              rounded(fits.front().rms, 3) + ": are frame and signs of the data what they are taken for?",
          best->remedy,
          {},
          best->remedy.starts_with("--frame ") ? best->remedy : ""};
}

std::string convention_warning(std::span<const ConventionFit> fits) {
  const Finding finding = convention_finding(fits);
  return finding.fault.empty() ? "" : finding.evidence + " " + finding.remedy;
}

std::string convention_warning(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping) {
  const Orders low{0, std::min(orders.other, 3)};
  if (convention_warning(convention_fits(samples, low, mapping, most_tried / 3)).empty()) return "";
  return convention_warning(convention_fits(samples, orders, mapping));
}

}  // namespace mmbrdf
