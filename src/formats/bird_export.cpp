// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <vector>

#include "formats/bird.hpp"
#include "formats/export_table.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/text/date.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "text/json_text.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using nlohmann::ordered_json;

constexpr const char* bird_schema =
    "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/brdf_json_schema_v1.0.json";

/// Light, or what an analyzer lets pass, in the convention s_first_right.
struct NamedState {
  const char* text;  ///< as in a file: a Stokes vector
  Stokes vector;
};
constexpr std::array named_states{NamedState{"[1, 0, 0, 0]", {1, 0, 0, 0}},   NamedState{"[1, 1, 0, 0]", {1, 1, 0, 0}},
                                  NamedState{"[1, -1, 0, 0]", {1, -1, 0, 0}}, NamedState{"[1, 0, 1, 0]", {1, 0, 1, 0}},
                                  NamedState{"[1, 0, -1, 0]", {1, 0, -1, 0}}, NamedState{"[1, 0, 0, 1]", {1, 0, 0, 1}},
                                  NamedState{"[1, 0, 0, -1]", {1, 0, 0, -1}}};

/// A value is the sum of elements, of the frame sp in this project's convention, with these weights: half of w M a behind
/// an analyzer.
struct StatePair {
  std::size_t incident, analyzed;  ///< of named_states
  std::array<double, 16> weights;
};

StatePair state_pair(std::size_t incident, std::size_t analyzed) {
  StatePair result{incident, analyzed, {}};
  const auto own = [](std::size_t state) {
    return convert(named_states[state].vector, StokesConvention::s_first_right, StokesConvention::germer2017);
  };
  const Stokes a = own(incident), w = own(analyzed);
  for (std::size_t e = 0; e < 16; ++e) result.weights[e] = (analyzed == 0 ? 1 : 0.5) * w[e / 4] * a[e % 4];
  return result;
}

struct ToldPairs {
  std::vector<StatePair> pairs;
  Elements left_out{};  ///< known ones that are told by none of the pairs
};

/// Unpolarized light without an analyzer, and all pairs of s and p, ±45 degrees and both circular states, as far as the
/// elements are known that these tell.
ToldPairs told_pairs(const Elements& unknown) {
  std::vector<StatePair> pairs{state_pair(0, 0)};
  std::size_t components = 4;
  const auto told = [&] {
    for (std::size_t e = 0; e < 16; ++e)
      if (unknown[e] && e / 4 < components && e % 4 < components) return false;
    return true;
  };
  while (components > 1 && !told()) --components;
  const std::size_t last = 2 * (components - 1);
  for (std::size_t analyzed = 1; analyzed <= last; ++analyzed)
    for (std::size_t incident = 1; incident <= last; ++incident) pairs.push_back(state_pair(incident, analyzed));
  ToldPairs result{std::move(pairs)};
  for (std::size_t e = 0; e < 16; ++e) result.left_out[e] = !unknown[e] && (e / 4 >= components || e % 4 >= components);
  return result;
}

/// Degrees from 0 on, up to what was fitted, which is among them, or 80.
std::vector<double> polar_nodes(int step, const std::optional<double>& fitted) {
  const double most = std::min(compared_theta, fitted.value_or(compared_theta));
  std::vector<double> result;
  for (int angle = 0; radians(angle) <= most + 1e-9; angle += step) result.push_back(angle);
  if (const double last = std::round(in_degrees(most) * 1e9) / 1e9; last - result.back() > 1e-6) result.push_back(last);
  return result;
}

std::vector<double> round_nodes(int step) {
  std::vector<double> result;
  for (int angle = 0; angle < 360; angle += step) result.push_back(angle);
  return result;
}

struct PointInDegrees {
  double theta_i, phi_i, theta_r, phi_r;
  Geometry geometry() const { return {direction_from_degrees(theta_i, phi_i), direction_from_degrees(theta_r, phi_r)}; }
};

struct PointSteps {
  int theta_i, phi_i, theta_r, phi_r;  ///< degrees; phi_i = 0: a turn of the sample changes nothing
};

/// Directions within those of the fit. Along the normal there is one azimuth.
std::vector<PointInDegrees> points_of(const PreparedModel& prepared, const Validity& validity, const PointSteps& step) {
  std::vector<PointInDegrees> result;
  for (const double theta_i : polar_nodes(step.theta_i, validity.theta_i_max))
    for (const double phi_i : step.phi_i > 0 ? round_nodes(step.phi_i) : std::vector<double>{0})
      for (const double theta_r : polar_nodes(step.theta_r, validity.theta_r_max))
        for (const double phi_r : theta_r > 0 ? round_nodes(step.phi_r) : std::vector<double>{0}) {
          const PointInDegrees point{theta_i, phi_i, theta_r, phi_r};
          if ((prepared.outside(point.geometry()) & outside_directions) == 0) result.push_back(point);
        }
  return result;
}

/// The same, at the nodes of DirectionPairs if none of the usual points is supported.
std::vector<PointInDegrees> points_of(const PreparedModel& prepared, const Validity& validity, bool turns_matter) {
  const auto of = [&](const PointSteps& step) { return points_of(prepared, validity, step); };
  std::vector<PointInDegrees> usual = of(turns_matter ? PointSteps{15, 45, 10, 30} : PointSteps{15, 0, 5, 15});
  return usual.empty() ? of(turns_matter ? PointSteps{10, 20, 10, 20} : PointSteps{5, 0, 5, 10}) : usual;
}

/// Values of all pairs of states at points of one wavelength.
struct BirdValues {
  double wavelength;
  std::vector<PointInDegrees> points;
  std::vector<double> values, uncertainties;  ///< pairs × points, the pair fastest; uncertainties may be empty
  std::size_t left_out = 0;                   ///< points of which a value is negative
};

double weighted(const std::array<double, 16>& weights, const Mueller& m) {
  double sum = 0;
  for (std::size_t e = 0; e < 16; ++e)
    if (weights[e] != 0) sum += weights[e] * m.elements[e];
  return sum;
}

double uncertainty_of(const std::array<double, 16>& weights, const MuellerCovariance& covariance) {
  double variance = 0;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t f = 0; f < 16; ++f)
      if (weights[e] != 0 && weights[f] != 0) variance += weights[e] * weights[f] * covariance(e, f);
  return std::sqrt(std::max(0.0, variance));
}

BirdValues values_at(const Model& model, double wavelength, const std::vector<StatePair>& pairs, bool turns_matter) {
  const PreparedModel prepared = prepare(model, wavelength);
  std::optional<PreparedUncertainty> uncertainty;
  if (knows_uncertainty(model)) uncertainty = prepare_uncertainty(model, wavelength);
  BirdValues result{wavelength, {}, {}, {}};
  for (const PointInDegrees& point : points_of(prepared, model.validity, turns_matter)) {
    const Mueller m = prepared.evaluate(point.geometry(), Frame::sp);
    if (std::ranges::any_of(pairs, [&](const StatePair& pair) { return weighted(pair.weights, m) < 0; })) {
      ++result.left_out;
      continue;
    }
    result.points.push_back(point);
    for (const StatePair& pair : pairs) result.values.push_back(weighted(pair.weights, m));
    if (!uncertainty) continue;
    const MuellerCovariance covariance = uncertainty->evaluate(point.geometry(), Frame::sp);
    for (const StatePair& pair : pairs) result.uncertainties.push_back(uncertainty_of(pair.weights, covariance));
  }
  return result;
}

/// A UUID that differs where values, model or time do (RFC 9562, version 8).
std::string identifier(const std::vector<BirdValues>& all, const std::string& text) {
  std::array<std::uint64_t, 2> hash{14695981039346656037U, 1099511628211U};
  const auto mix = [&](std::uint64_t bits) {
    for (std::uint64_t& one : hash) one = ((one ^ bits) * 1099511628211U) ^ (one >> 29);
  };
  for (const char c : text) mix(static_cast<unsigned char>(c));
  for (const BirdValues& at : all)
    for (const double value : at.values) mix(std::bit_cast<std::uint64_t>(value));
  std::array<char, 80> uuid{};
  std::snprintf(uuid.data(), uuid.size(), "urn:uuid:%08x-%04x-8%03x-%04x-%012llx", static_cast<unsigned>(hash[0] >> 32),
                static_cast<unsigned>(hash[0] >> 16 & 0xffff), static_cast<unsigned>(hash[0] & 0xfff),
                static_cast<unsigned>(0x8000 | (hash[1] >> 48 & 0x3fff)),
                static_cast<unsigned long long>(hash[1] & 0xffffffffffffU));
  return uuid.data();
}

constexpr const char* not_stated = "not stated";

/// Whom to ask. The address is one that cannot be (RFC 2606).
ordered_json origin(const Model& model) {
  ordered_json result{{"organization", not_stated},
                      {"location",
                       {{"country", not_stated},
                        {"city", not_stated},
                        {"street", not_stated},
                        {"building_nr", not_stated},
                        {"postal_code", not_stated}}},
                      {"email", "not-stated@example.invalid"},
                      {"contact_person", not_stated}};
  const auto attribution = model.provenance.find("attribution");
  if (attribution != model.provenance.end()) result["comments"] = attribution->second;
  return result;
}

ordered_json software(const Model& model, const std::string& name) {
  return {{"name", "mmbrdf"},
          {"version", MMBRDF_PROJECT_VERSION},
          {"simulation_model",
           {{"name", name},
            {"description", "Mueller-matrix BRDF fitted to measured samples"},
            {"comments", basis_line(model)}}}};
}

ordered_json sample_of(const std::string& name, bool turns_matter) {
  return {{"name", name},
          {"type", not_stated},
          {"shape", not_stated},
          {"dimensions", ordered_json::object()},
          {"properties_symmetry", turns_matter ? "anisotropic" : "isotropic"},
          {"zero_azimuth_location", turns_matter ? "that of the model" : "any: the sample is isotropic"}};
}

/// What the schema requires; it has no word but text for what is not known.
ordered_json metadata(const Model& model, bool turns_matter, const std::vector<BirdValues>& all) {
  const std::string name = model.name.empty() ? not_stated : printable(model.name, 200), time = utc_timestamp();
  ordered_json provenance = ordered_json::object();
  for (const auto& [key, text] : model.provenance) provenance[key] = text;
  return {{"schema", bird_schema},
          {"id", identifier(all, time + basis_line(model) + name)},
          {"type", "BRDF"},
          {"timestamp", time},
          {"provenance", origin(model)},
          {"description", "BRDF of a model of the sample " + name + " at directions that its measurement supports"},
          {"method", "simulation"},
          {"instrumentation", "NA"},
          {"software", software(model, name)},
          {"sample", sample_of(name, turns_matter)},
          {"environment", "NA"},
          {"adhoc_section", {{"fitted_range", fitted_range(model.validity)}, {"provenance_of_the_model", provenance}}}};
}

/// Throws std::invalid_argument for texts that JSON cannot have.
std::string metadata_text(const Model& model, bool turns_matter, const std::vector<BirdValues>& all) {
  try {
    return json_text(metadata(model, turns_matter, all));
  } catch (const nlohmann::json::exception& e) {
    throw std::invalid_argument("name or provenance of the model: " + std::string(e.what()));
  }
}

/// The lists of `data`, a value for each pair of states at each point of each wavelength.
class BirdLists {
 public:
  BirdLists(std::ostream& out, const std::vector<BirdValues>& all, const std::vector<StatePair>& pairs)
      : out_(out), all_(all), pairs_(pairs) {}

  void write(bool uncertain, bool polarized) {
    out_ << "{\n";
    angle("theta_i", &PointInDegrees::theta_i);
    angle("phi_i", &PointInDegrees::phi_i);
    angle("theta_r", &PointInDegrees::theta_r);
    angle("phi_r", &PointInDegrees::phi_r);
    list(R"("wavelength_i": {"name": "wavelength_i", "unit": "nm")",
         [](const BirdValues& at, std::size_t) { return shortest(in_nanometres(at.wavelength)); });
    if (polarized) {
      const std::string frame =
          R"(", "notation": "inStokes", "comments": "s first, +45 degrees from s towards p, right-handed positive)";
      list(R"("polarization_i": {"name": "polarization_i)" + frame + "\"", [this](const BirdValues&, std::size_t n) {
        return std::string(named_states[pairs_[n % pairs_.size()].incident].text);
      });
      list(R"("polarization_r": {"name": "polarization_r)" + frame +
               R"(; [1, 0, 0, 0] is a receiver without an analyzer")",
           [this](const BirdValues&, std::size_t n) {
             return std::string(named_states[pairs_[n % pairs_.size()].analyzed].text);
           });
    }
    if (uncertain)
      list(
          R"("uBRDF": {"name": "BRDF", "unit": "1/sr", "comments": "standard uncertainties, k = 1, of the sample as the )"
          R"(fit left it; those of one geometry are correlated")",
          [](const BirdValues& at, std::size_t n) { return rounded(at.uncertainties[n], 4); });
    list(R"("BRDF": {"name": "BRDF", "unit": "1/sr")",
         [](const BirdValues& at, std::size_t n) { return rounded(at.values[n], 8); }, "\n");
    out_ << "}";
  }

 private:
  void angle(const std::string& name, double PointInDegrees::*which) {
    list('"' + name + R"(": {"name": ")" + name + R"(", "unit": "deg")",
         [this, which](const BirdValues& at, std::size_t n) { return shortest(at.points[n / pairs_.size()].*which); });
  }

  template <class Text>
  void list(const std::string& head, const Text& text, const char* end = ",\n") {
    out_ << head << ", \"values\": [";
    std::string line;
    bool first = true;
    for (const BirdValues& at : all_)
      for (std::size_t n = 0; n < at.values.size(); ++n) {
        if (line.size() > 100) out_ << line << '\n', line.clear();
        line += (first ? "" : ", ") + text(at, n);
        first = false;
      }
    out_ << line << "]}" << end;
  }

  std::ostream& out_;
  const std::vector<BirdValues>& all_;
  const std::vector<StatePair>& pairs_;
};

std::string counted_geometries(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " geometry" : " geometries");
}

/// What of the wavelengths and elements is not in it.
std::string missing_text(const std::vector<BirdValues>& all, const Elements& elements) {
  std::size_t negative = 0;
  std::vector<double> empty;
  for (const BirdValues& at : all) {
    negative += at.left_out;
    if (at.points.empty()) empty.push_back(at.wavelength);
  }
  std::string text;
  if (negative > 0) text += "; " + counted_geometries(negative) + " left out, where a value is negative";
  if (!empty.empty()) text += "; no geometry left at " + nanometre_text(empty);
  if (elements.any())
    text += "; not written: " + element_names(elements) + ", which these states tell only with elements not measured";
  return text;
}

std::string bird_understood(const std::vector<BirdValues>& all, std::size_t pairs, bool uncertain) {
  std::size_t points = 0;
  std::vector<double> wavelengths;
  for (const BirdValues& at : all)
    if (!at.points.empty()) points += at.points.size(), wavelengths.push_back(at.wavelength);
  std::string text = counted_geometries(points) + " at " + nanometre_text(wavelengths);
  text += pairs == 1 ? ", f11 in sr^-1"
                     : ", values in sr^-1 between " + std::to_string(pairs) +
                           " pairs of states, s first, S4 > 0 right-handed, frame sp";
  return text + (uncertain ? ", uBRDF with k = 1" : ", without uncertainties, which the model does not know");
}

/// Throws std::invalid_argument if no value at all is left, with the reason.
void require_values(const std::vector<BirdValues>& all) {
  if (std::ranges::any_of(all, [](const BirdValues& at) { return !at.points.empty(); })) return;
  if (std::ranges::any_of(all, [](const BirdValues& at) { return at.left_out > 0; }))
    throw std::invalid_argument(
        "a BiRD file has no negative values, and this model has some at each of its geometries");
  throw std::invalid_argument("no samples support any of the directions of a BiRD file");
}

}  // namespace

Export::Made make_bird(const Model& model, const ExportOptions& options) {
  const bool turns_matter = depends_on_azimuth_of_source(model);
  const auto [pairs, left_out] = told_pairs(unknown_elements(model, Frame::sp));
  std::vector<BirdValues> all;
  for (const double wavelength : options.wavelengths) all.push_back(values_at(model, wavelength, pairs, turns_matter));
  require_values(all);
  const bool uncertain = knows_uncertainty(model);
  const std::string understood = bird_understood(all, pairs.size(), uncertain) + missing_text(all, left_out) +
                                 "; values as the model has them, nothing is interpolated",
                    head = metadata_text(model, turns_matter, all);
  const bool knows_angles = model.validity.theta_i_max && model.validity.theta_r_max;  // else to where is a guess
  const auto shared = std::make_shared<const std::vector<BirdValues>>(std::move(all));
  const auto write = [shared, pairs = pairs, head, uncertain](std::ostream& out) {
    out << "{\n\"metadata\": " << head << ",\n\"data\": ";
    BirdLists(out, *shared, pairs).write(uncertain, pairs.size() > 1);
    out << "\n}\n";
  };
  return {.write = write, .error = {}, .understood = understood, .extrapolates = !knows_angles};
}

}  // namespace mmbrdf
