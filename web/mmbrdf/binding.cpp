// SPDX-License-Identifier: BSD-3-Clause
// What index.js calls: it converts, and computes nothing. Angles are in degrees and wavelengths in nanometres. Functions
// that may fail return 0 then, and error_text() says why. Lists of numbers are in the memory of the module; facts are JSON.
#include <emscripten.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "hemisphere.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/text/units.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;
using namespace mmbrdf::web;
using nlohmann::ordered_json;

namespace {

/// JSON has no word for what is not known but null.
template <class T>
ordered_json or_null(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

Geometry geometry(const double* degrees) {
  return {direction_from_degrees(degrees[0], degrees[1]), direction_from_degrees(degrees[2], degrees[3])};
}

std::vector<Geometry> geometries(const double* degrees, std::size_t count) {
  std::vector<Geometry> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = geometry(degrees + 4 * i);
  return result;
}

/// Facts about it are asked for often, uncertainties seldom: they take far longer to prepare.
struct At {
  const Model& model;
  PreparedModel prepared;
  std::optional<PreparedUncertainty> prepared_uncertainty = {};
  std::map<std::pair<Frame, bool>, PreparedAnswers> prepared_answers = {};  // by frame, and whether with parts

  const PreparedUncertainty* uncertainty() {
    if (!prepared_uncertainty && knows_uncertainty(model))
      prepared_uncertainty = prepare_uncertainty(model, prepared.wavelength());
    return prepared_uncertainty ? &*prepared_uncertainty : nullptr;
  }

  const PreparedAnswers& answers(Frame frame, bool parts) {
    const auto known = prepared_answers.find({frame, parts});
    if (known != prepared_answers.end()) return known->second;
    const Answers answers(model, {.frame = frame, .parts = parts});
    return prepared_answers.emplace(std::pair(frame, parts), answers.at(prepared.wavelength())).first->second;
  }
};

ordered_json answered_json(const Answer& answer) {
  ordered_json list = ordered_json::array();
  for (const Answered& a : answer.quantities) {
    ordered_json one = {
        {"name", a.quantity->name}, {"value", or_null(a.value)}, {"uncertainty", or_null(a.uncertainty)}};
    one["parts"] = ordered_json::object();
    for (std::size_t k = 0; answer.budget && k < answer.budget->terms.size() && k < a.parts.size(); ++k)
      one["parts"][answer.budget->terms[k].name] = a.parts[k];
    list.push_back(one);
  }
  return list;
}

/// Standard uncertainties of f11 by cause.
ordered_json budget_json(const std::optional<Budget>& budget) {
  ordered_json result = ordered_json::array();
  if (!budget) return result;
  for (const BudgetTerm& term : budget->terms)
    result.push_back({{"name", term.name}, {"u_f11", std::sqrt(std::max(0.0, term.covariance(0, 0)))}});
  return result;
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* error_text() { return last_error.c_str(); }

/// What there is, whatever the model.
EMSCRIPTEN_KEEPALIVE const char* about() {
  return guarded([] {
    ordered_json json = {{"version", MMBRDF_PROJECT_VERSION}, {"materials", materials()}};
    for (const Quantity& q : quantities(false))
      json["quantities"].push_back({{"name", q.name}, {"unit", q.unit}, {"meaning", q.meaning}});
    for (int f = 0; f <= static_cast<int>(Frame::scattering_plane); ++f)
      json["frames"].push_back(to_string(frame_numbered(f)));
    for (int c = 0; c <= static_cast<int>(StokesConvention::p_first_left_handed_axes_right); ++c)
      json["conventions"].push_back(to_string(convention_numbered(c)));
    return text_of(json);
  });
}

EMSCRIPTEN_KEEPALIVE Model* material_named(const char* name) {
  return guarded([&] { return new Model(material(name)); });
}

EMSCRIPTEN_KEEPALIVE Model* model_read(const char* text, std::size_t length, const char* path) {
  return guarded([&] { return new Model(model_from_text({text, length}, path)); });
}

EMSCRIPTEN_KEEPALIVE void free_model(Model* model) { delete model; }

EMSCRIPTEN_KEEPALIVE const char* describe(const Model* model) {
  return guarded([&] {
    const auto degrees = [](const std::optional<double>& angle) {
      return angle ? ordered_json(in_degrees(*angle)) : ordered_json(nullptr);
    };
    ordered_json json = {{"name", model->name},
                         {"basis", basis_line(*model)},
                         {"fittedRange", fitted_range(model->validity)},
                         {"thetaIMax", degrees(model->validity.theta_i_max)},
                         {"thetaRMax", degrees(model->validity.theta_r_max)},
                         {"hasUncertainty", knows_uncertainty(*model)},
                         {"provenance", model->provenance}};
    json["wavelengths"] = ordered_json::array();
    if (knows_wavelength(*model))
      for (const double wavelength : known_wavelengths(*model))
        json["wavelengths"].push_back(in_nanometres(wavelength));
    return text_of(json);
  });
}

/// The model must outlive it.
EMSCRIPTEN_KEEPALIVE At* at_wavelength(const Model* model, double nanometres) {
  return guarded([&] { return new At{*model, prepare(*model, nanometres / 1000)}; });
}

EMSCRIPTEN_KEEPALIVE void free_at(At* at) { delete at; }

EMSCRIPTEN_KEEPALIVE int evaluate_at(const At* at, const double* degrees, std::size_t count, int frame, int convention,
                                     int divided, Mueller* out) {
  return guarded([&] {
    at->prepared.evaluate(geometries(degrees, count), frame_numbered(frame), {out, count});
    for (Mueller& m : std::span(out, count)) {
      m = convert(m, StokesConvention::germer2017, convention_numbered(convention));
      if (!divided) continue;
      const double f11 = m(0, 0);
      m = normalized(m);
      m(0, 0) = f11;
    }
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE int uncertainty_at(At* at, const double* degrees, std::size_t count, int frame, int divided,
                                        Mueller* out) {
  return guarded([&] {
    const std::vector<Geometry> asked = geometries(degrees, count);
    const PreparedUncertainty* const u = at->uncertainty();
    if (!u)
      for (Mueller& m : std::span(out, count)) m.elements.fill(unknown);
    else if (divided)
      for (std::size_t i = 0; i < count; ++i)
        out[i] = standard_uncertainty(u->normalized(asked[i], frame_numbered(frame)));
    else
      u->standard_uncertainty(asked, frame_numbered(frame), {out, count});
    return 1;
  });
}

/// Bits of Outside.
EMSCRIPTEN_KEEPALIVE int outside_at(const At* at, const double* degrees, std::size_t count, std::uint32_t* out) {
  return guarded([&] {
    for (std::size_t i = 0; i < count; ++i) {
      const Geometry asked = geometry(degrees + 4 * i);
      require_valid(asked);
      out[i] = at->prepared.outside(asked);
    }
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE const char* outside_words(const At* at, std::uint32_t reasons) {
  return guarded([&] {
    const Outside outside = static_cast<Outside>(reasons);
    return text_of({{"validity", to_string(outside)},
                    {"extrapolated", leaves_known_range(outside)},
                    {"line", leaves_known_range(outside) ? outside_line(outside, at->model.validity) : std::string()}});
  });
}

/// The modes of the model, block after block.
EMSCRIPTEN_KEEPALIVE const char* modes_of(const Model* model) {
  return guarded([&] {
    ordered_json json = ordered_json::array();
    for (const FittedBlock& fitted : model->blocks)
      for (const Mode& mode : fitted.block.modes)
        json.push_back({{"block", fitted.block.name},
                        {"function", to_string(mode.function)},
                        {"n", mode.n},
                        {"m", mode.m},
                        {"k", mode.k},
                        {"l", mode.l}});
    return text_of(json);
  });
}

/// As many numbers as there are modes.
EMSCRIPTEN_KEEPALIVE void coefficients_at(const At* at, double* out) {
  std::ranges::copy(at->prepared.coefficients(), out);
}

/// Values and standard uncertainties, one list of `count` for each quantity of the table.
EMSCRIPTEN_KEEPALIVE int quantities_at(At* at, const double* degrees, std::size_t count, double* values,
                                       double* uncertainties) {
  return guarded([&] {
    const std::vector<Answer> answers = at->answers(Frame::xy, false).at(geometries(degrees, count));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t q = 0; q < answers[i].quantities.size(); ++q) {
        values[q * count + i] = answers[i].quantities[q].value.value_or(unknown);
        uncertainties[q * count + i] = answers[i].quantities[q].uncertainty.value_or(unknown);
      }
    return 1;
  });
}

/// All that the model says at one geometry.
EMSCRIPTEN_KEEPALIVE const char* answer_at(At* at, const double* degrees, int frame, int convention) {
  return guarded([&] {
    const Answer answer = at->answers(frame_numbered(frame), true).at(geometry(degrees));
    const Mueller m = convert(answer.elements, StokesConvention::germer2017, convention_numbered(convention));
    return text_of(
        {{"elements", m.elements},
         {"uncertainties", answer.uncertainties ? ordered_json(answer.uncertainties->elements) : ordered_json(nullptr)},
         {"validity", to_string(answer.outside)},
         {"extrapolated", leaves_known_range(answer.outside)},
         {"estimable", or_null(answer.estimable)},
         {"realizable", or_null(answer.realizable)},
         {"budget", budget_json(answer.budget)},
         {"quantities", answered_json(answer)}});
  });
}

/// Directional-hemispherical reflectances of unpolarized light from these polar angles, and their uncertainties.
EMSCRIPTEN_KEEPALIVE int dhr_at(At* at, const double* degrees, std::size_t count, double* values,
                                double* uncertainties) {
  return guarded([&] {
    std::vector<Direction> directions(count);
    for (std::size_t i = 0; i < count; ++i) {
      directions[i] = direction_from_degrees(degrees[i], 0);
      values[i] = directional_hemispherical_reflectance(at->model, at->prepared.wavelength(), directions[i]);
      uncertainties[i] = unknown;
    }
    if (const PreparedUncertainty* const u = at->uncertainty())
      u->directional_hemispherical_reflectance(directions, {uncertainties, count});
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE web::Hemisphere* new_hemisphere(int pixels, int lambert) {
  return guarded([&] { return new web::Hemisphere(pixels, lambert != 0); });
}
EMSCRIPTEN_KEEPALIVE void free_hemisphere(web::Hemisphere* hemisphere) { delete hemisphere; }
EMSCRIPTEN_KEEPALIVE std::size_t hemisphere_count(const web::Hemisphere* hemisphere) { return hemisphere->count(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* hemisphere_positions(const web::Hemisphere* hemisphere) {
  return hemisphere->positions();
}
EMSCRIPTEN_KEEPALIVE float* hemisphere_values(web::Hemisphere* hemisphere) { return hemisphere->values(); }
EMSCRIPTEN_KEEPALIVE float* hemisphere_limits(web::Hemisphere* hemisphere) { return hemisphere->limits(); }
EMSCRIPTEN_KEEPALIVE std::uint32_t* hemisphere_colors(web::Hemisphere* hemisphere) { return hemisphere->colors(); }
EMSCRIPTEN_KEEPALIVE std::uint32_t* hemisphere_image(web::Hemisphere* hemisphere) { return hemisphere->image(); }

EMSCRIPTEN_KEEPALIVE int hemisphere_evaluate(web::Hemisphere* hemisphere, const At* at, double theta, double phi,
                                             int frame, int convention, int divided) {
  return guarded([&] {
    hemisphere->evaluate(at->prepared, direction_from_degrees(theta, phi), frame_numbered(frame),
                         convention_numbered(convention), divided != 0);
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE int hemisphere_subtract(web::Hemisphere* hemisphere, const web::Hemisphere* first) {
  return guarded([&] {
    hemisphere->subtract(*first);
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE void hemisphere_extremes(const web::Hemisphere* hemisphere, float* out) {
  hemisphere->extremes(out);
}
EMSCRIPTEN_KEEPALIVE void hemisphere_paint(web::Hemisphere* hemisphere) { hemisphere->paint(); }

}  // extern "C"
