// SPDX-License-Identifier: BSD-3-Clause
#include "formats/angle_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formats/export_table.hpp"
#include "formats/reader.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::array steps{10.0, 5.0, 2.5};  // degrees

struct Place {
  std::size_t below;
  double part;
};

Place place(double x, std::size_t last) {
  const std::size_t below = std::min(static_cast<std::size_t>(x), last);
  return {below, x - static_cast<double>(below)};
}

}  // namespace

AngleTable::AngleTable(const Model& model, const ExportOptions& options, const std::string& what) {
  require_isotropic(model, what);
  const auto value = channel_of(model, options.channel);
  std::vector<PreparedModel> models;
  for (const double wavelength : options.wavelengths) models.push_back(prepare(model, wavelength));
  wavelengths_ = models.size();
  const double theta_max = compared_up_to(model);
  const std::vector<Geometry> compared = random_geometries(4000, 1, theta_max);
  double step = 0;
  for (const double degrees : steps) {
    step = degrees;
    thetas_ = static_cast<std::size_t>(std::lround(90 / step)) + 1;
    azimuths_ = static_cast<std::size_t>(std::lround(360 / step));
    values_.resize(rows() * wavelengths_);
    std::size_t at = 0;
    each([&](const Row& row) {
      for (const PreparedModel& prepared : models)
        values_[at++] = value(prepared.evaluate({{row.theta_i, 0}, {row.theta_r, row.phi_r}}, Frame::sp));
    });
    Deviation deviation;
    for (std::size_t w = 0; w < wavelengths_; ++w)
      for (const Geometry& geometry : compared) {
        const Mueller m = models[w].evaluate(geometry, Frame::sp);
        deviation.add(looked_up(geometry, w), value(m), m(0, 0));
      }
    error_ = deviation.error(theta_max);
    if (error_.rms <= options.error) break;
  }
  require_error(error_, options, "steps of " + shortest(step) + " degrees");
  understood_ = options.channel + " in sr^-1 at " + nanometre_text(options.wavelengths) +
                ", polar angles of 0 to 90 and azimuths of 0 to 360 degrees in steps of " + shortest(step) +
                ", phi_i = 0";
  if (const auto negative = std::ranges::count_if(values_, [](double v) { return v < 0; }); negative > 0)
    understood_ += "; " + std::to_string(negative) + " of " + std::to_string(values_.size()) + " values are negative";
}

void AngleTable::each(const std::function<void(const Row&)>& use) const {
  const auto angle = [](std::size_t k, std::size_t parts, double whole) {
    return whole * static_cast<double>(k) / static_cast<double>(parts);
  };
  const double* at = values_.data();
  for (std::size_t i = 0; i < thetas_; ++i)
    for (std::size_t r = 0; r < thetas_; ++r)
      for (std::size_t p = 0; p < azimuths_; ++p, at += wavelengths_)
        use({angle(i, thetas_ - 1, half_pi),
             angle(r, thetas_ - 1, half_pi),
             angle(p, azimuths_, 4 * half_pi),
             {at, wavelengths_}});
}

double AngleTable::looked_up(const Geometry& geometry, std::size_t w) const {
  const double turns = (geometry.reflected.phi - geometry.incident.phi) / (4 * half_pi);
  const auto polar = [&](double theta) {
    return place(theta / half_pi * static_cast<double>(thetas_ - 1), thetas_ - 2);
  };
  const Place i = polar(geometry.incident.theta), r = polar(geometry.reflected.theta),
              p = place((turns - std::floor(turns)) * static_cast<double>(azimuths_), azimuths_ - 1);
  double sum = 0;
  for (const std::size_t corner : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
    const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const std::size_t row = ((i.below + a) * thetas_ + r.below + b) * azimuths_ + (p.below + c) % azimuths_;
    sum += (a ? i.part : 1 - i.part) * (b ? r.part : 1 - r.part) * (c ? p.part : 1 - p.part) *
           values_[row * wavelengths_ + w];
  }
  return sum;
}

}  // namespace mmbrdf
