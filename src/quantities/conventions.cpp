// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/conventions.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Signs = std::array<int, 4>;

/// How a measured matrix becomes the one in frame xy: from a frame, or with other signs of the Stokes components.
struct Convention {
  const char* name;
  Frame frame = Frame::xy;
  Signs scattered{1, 1, 1, 1}, incident{1, 1, 1, 1};
};

constexpr Signs as_is{1, 1, 1, 1}, s2{1, -1, 1, 1}, s3{1, 1, -1, 1}, s4{1, 1, 1, -1}, s2_s3{1, -1, -1, 1},
    s3_s4{1, 1, -1, -1};

constexpr std::array conventions{
    Convention{.name = "frame xy"},
    Convention{.name = "frame sp", .frame = Frame::sp},
    Convention{.name = "frame scattering_plane", .frame = Frame::scattering_plane},
    Convention{.name = "S3 of both beams reversed, or transposed", .scattered = s3, .incident = s3},
    Convention{.name = "S2 of the source reversed", .scattered = as_is, .incident = s2},
    Convention{.name = "S2 of the receiver reversed", .scattered = s2},
    Convention{.name = "S3 of the source reversed", .incident = s3},
    Convention{.name = "S3 of the receiver reversed", .scattered = s3},
    Convention{.name = "S4 of one beam reversed", .incident = s4},
    Convention{.name = "S3 and S4 of the source reversed", .incident = s3_s4},
    Convention{.name = "S3 and S4 of the receiver reversed", .scattered = s3_s4},
    Convention{.name = "axes of one beam turned by 90 degrees", .incident = s2_s3}};

Mueller read_as(const Convention& convention, const Sample& sample) {
  Mueller m = sample.normalized;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      m(i, j) *= convention.scattered[static_cast<std::size_t>(i)] * convention.incident[static_cast<std::size_t>(j)];
  return change_frame(m, sample.geometry, convention.frame, Frame::xy);
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

}  // namespace

std::vector<ConventionFit> convention_fits(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping,
                                           std::size_t most) {
  const std::vector<Sample> some = some_of(samples, most);
  for (const Sample& sample : some)  // frames would lose elements, and be compared by others
    if (const Elements unknown = not_measured(sample);
        sample.as_measured || turned_into(unknown) != unknown || unknown.count() >= 15)
      return {};
  FitOptions options;
  options.minimum_norm = true;
  std::vector<ConventionFit> result;
  for (const Convention& convention : conventions) {
    std::vector<Sample> read = some;
    for (Sample& sample : read) sample.normalized = read_as(convention, sample);
    FitAccumulator accumulator({Family::isotropic, {0, orders.other}, mapping});
    accumulator.add(read);
    result.push_back({convention.name, polarization_rms(accumulator.solve(options))});
  }
  return result;
}

std::string convention_warning(std::span<const ConventionFit> fits) {
  constexpr double rounding = 1e-9;  // of simulated data without noise
  const auto best = std::ranges::min_element(fits, {}, &ConventionFit::rms);
  if (best == fits.end() || !(fits.front().rms > better_convention * std::max(best->rms, rounding))) return "";
  return "read as " + best->read_as + " the residuals would be " + rounded(best->rms, 3) + " instead of " +
         rounded(fits.front().rms, 3) + ": are frame and signs of the data what they are taken for?";
}

std::string convention_warning(std::span<const Sample> samples, const Orders& orders, DiscMapping mapping) {
  const Orders low{0, std::min(orders.other, 3)};
  if (convention_warning(convention_fits(samples, low, mapping, most_tried / 3)).empty()) return "";
  return convention_warning(convention_fits(samples, orders, mapping));
}

}  // namespace mmbrdf
