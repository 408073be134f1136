// SPDX-License-Identifier: BSD-3-Clause
#include "formats/zemax.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "formats/text_file.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

struct Axis {
  const char* name;
  double least, most;  // degrees
  std::vector<double> angles = {};
};

class ZemaxReader : public ForeignFile::Reader {
 public:
  explicit ZemaxReader(const Source& source)
      : file_(source.path),
        path_(source.path),
        most_(source.size),
        axes_{{{"SampleRotation", -360, 360},
               {"AngleOfIncidence", 0, 90},
               {"ScatterAzimuth", -360, 360},
               {"ScatterRadial", 0, 180}}} {
    while (read_keyword()) continue;
    if (axes_[0].angles.empty()) axes_[0].angles = {0};
    for (const Axis& axis : axes_)
      if (axis.angles.empty())
        throw file_.error(std::string("no angles of ") + axis.name + " before the data: cut off?");
    wavelength_ = source.told_wavelengths(1, "values").front();
    understood = symmetry_ + ", angles about the specular ray made into those of the surface, f11 = BSDF in sr^-1 at " +
                 nanometre_text(std::array{wavelength_}) + " as told, TIS not read";
    if (axes_[0].angles.size() > 1) understood += ", phi_i = sample rotation";
    if (same_word(symmetry_, "PlaneSymmetrical")) understood += ", the half that the file has";
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    std::uint64_t repeated = 0;
    for (const double rotation : axes_[0].angles)
      for (const double theta_i : axes_[1].angles) repeated += read_table(rotation, theta_i, sink);
    if (const std::string_view end = file_.word('#'); end != "DataEnd")
      throw file_.error(in_quotes(end) + " in place of DataEnd behind the data of " +
                        std::to_string(axes_[0].angles.size() * axes_[1].angles.size()) + " incidences: cut off?");
    sink.finish(path_);
    passed_over = sink.passed_over("values");
    if (repeated > 0) passed_over += "; repeats of a direction passed over: " + std::to_string(repeated);
  }

 private:
  /// False where the data begin.
  bool read_keyword() {
    const std::string word(file_.word('#'));
    if (word.empty()) throw file_.error("the header ends without DataBegin: cut off?");
    for (Axis& axis : axes_)
      if (same_word(word, axis.name)) return read_angles(axis), true;
    if (same_word(word, "DataBegin")) return false;
    if (same_word(word, "Source")) return file_.skip_line(), true;
    if (same_word(word, "Symmetry")) {
      symmetry_ = file_.word('#');
      constexpr std::array known{"PlaneSymmetrical", "ASymmetrical", "ASymmetrical4D"};
      if (std::ranges::none_of(known, [&](const char* one) { return same_word(one, symmetry_); }))
        throw file_.error("Symmetry " + in_quotes(symmetry_) +
                          " is none of PlaneSymmetrical, Asymmetrical, ASymmetrical4D");
    } else if (same_word(word, "SpectralContent")) {
      const std::string_view content = file_.word('#');
      if (!same_word(content, "Monochrome"))
        throw file_.error("SpectralContent " + in_quotes(content) +
                          ": tristimulus values have no wavelength; write the file as Monochrome");
    } else if (same_word(word, "ScatterType")) {
      const std::string_view type = file_.word('#');
      if (!same_word(type, "BRDF"))
        throw file_.error("ScatterType " + in_quotes(type) + ": only reflection, BRDF, can be read");
    } else if (!same_word(word, "Monochrome")) {
      throw file_.error("keyword " + in_quotes(word) + " is not known");
    }
    return true;
  }

  void read_angles(Axis& axis) {
    const double count = file_.number(file_.word('#'), axis.name);
    if (!(count >= 1) || count != std::floor(count) || count > static_cast<double>(most_))
      throw file_.error(std::string(axis.name) + ": " + shortest(count) +
                        " is no number of angles that the file can hold");
    axis.angles.clear();
    for (double n = 0; n < count; ++n) {
      const double angle = file_.number(file_.word('#'), axis.name);
      if (!(angle >= axis.least && angle <= axis.most))
        throw file_.error(std::string(axis.name) + ": " + shortest(angle) + " degrees, must be in [" +
                          shortest(axis.least) + ", " + shortest(axis.most) + "]");
      axis.angles.push_back(angle);
    }
  }

  /// Of one incidence. Returns how many values say the same of the same direction again: all azimuths are one at radial
  /// angle 0, and 360 degrees is 0.
  std::uint64_t read_table(double rotation, double theta_i, SampleSink& sink) {
    if (const std::string_view word = file_.word('#'); word != "TIS")
      throw file_.error(in_quotes(word) + " in place of TIS before the data of AngleOfIncidence " + shortest(theta_i) +
                        ": cut off?");
    file_.number(file_.word('#'), "TIS");
    const auto& azimuths = axes_[2].angles;
    const auto& radials = axes_[3].angles;
    std::vector<double> first;
    std::uint64_t repeated = 0;
    for (const double azimuth : azimuths)
      for (std::size_t r = 0; r < radials.size(); ++r) {
        const double value = file_.number(file_.word('#'), "value");
        if (first.size() == r) first.push_back(value);
        const bool again = azimuth != azimuths[0] && (radials[r] == 0 || std::abs(azimuth - azimuths[0]) == 360);
        if (again && value == first[r])
          ++repeated;
        else
          add(rotation, theta_i, azimuth, radials[r], value, sink);
      }
    return repeated;
  }

  void add(double rotation, double theta_i, double azimuth, double radial, double value, SampleSink& sink) const {
    const Vector3 o = about_specular(radians(theta_i), radians(azimuth), radians(radial));
    if (o[2] <= 0) return sink.below_horizon();
    Geometry geometry{direction_from_degrees(theta_i, rotation), direction(o)};
    geometry.reflected.phi += radians(rotation);
    sink.add(scalar_sample(wavelength_, geometry, value));
  }

  TextFile file_;
  std::string path_, symmetry_ = "no symmetry said";
  std::uint64_t most_;
  std::array<Axis, 4> axes_;
  double wavelength_ = 0;
};

}  // namespace

Vector3 about_specular(double theta_i, double azimuth, double radial) {
  const double x = std::sin(radial) * std::cos(azimuth), y = std::sin(radial) * std::sin(azimuth), z = std::cos(radial);
  return {x * std::cos(theta_i) - z * std::sin(theta_i), y, x * std::sin(theta_i) + z * std::cos(theta_i)};
}

bool is_zemax(std::string_view head, std::uint64_t) {
  return has_keyword(head, "ScatterRadial") || has_keyword(head, "ScatterAzimuth") ||
         (has_keyword(head, "SpectralContent") && has_keyword(head, "Symmetry")) ||
         (has_keyword(head, "Source") && has_keyword(head, "Symmetry"));
}

std::unique_ptr<ForeignFile::Reader> open_zemax(const Source& source) { return std::make_unique<ZemaxReader>(source); }

}  // namespace mmbrdf
