// SPDX-License-Identifier: BSD-3-Clause
// The C interface is a way to call the library, and computes nothing.
#include "mmbrdf.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calls.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/quantities/quantities.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;
using namespace mmbrdf::c;

// The version of project() in CMakeLists.txt, which the header repeats for the preprocessor.
static_assert(std::string_view(MMBRDF_VERSION) == MMBRDF_PROJECT_VERSION);
// Numbers of the header are those of the library.
constexpr bool same(int number, auto enumerator) { return number == static_cast<int>(enumerator); }
static_assert(same(MMBRDF_OUTSIDE_THETA_I, outside_theta_i) && same(MMBRDF_OUTSIDE_THETA_R, outside_theta_r) &&
              same(MMBRDF_OUTSIDE_WAVELENGTH, outside_wavelength) && same(MMBRDF_UNKNOWN_RANGE, unknown_range) &&
              same(MMBRDF_OUTSIDE_DIRECTIONS, outside_directions) && same(MMBRDF_INTERPOLATED, interpolated));
static_assert(same(MMBRDF_XY, Frame::xy) && same(MMBRDF_SP, Frame::sp) &&
              same(MMBRDF_SCATTERING_PLANE, Frame::scattering_plane));
static_assert(same(MMBRDF_GERMER2017, StokesConvention::germer2017) &&
              same(MMBRDF_S_FIRST_RIGHT, StokesConvention::s_first_right) &&
              same(MMBRDF_P_FIRST_LEFT, StokesConvention::p_first_left) &&
              same(MMBRDF_P_FIRST_RIGHT, StokesConvention::p_first_right) &&
              same(MMBRDF_P_FIRST_LEFT_HANDED_AXES_LEFT, StokesConvention::p_first_left_handed_axes_left) &&
              same(MMBRDF_P_FIRST_LEFT_HANDED_AXES_RIGHT, StokesConvention::p_first_left_handed_axes_right));

struct mmbrdf_model {
  explicit mmbrdf_model(Model&& read) : model(std::make_shared<const Model>(std::move(read))) {}

  std::shared_ptr<const Model> model;
  std::string basis = basis_line(*model), fitted_range = mmbrdf::fitted_range(model->validity);
};

/// Made when it is first asked for: the uncertainties of a model take far longer to prepare than its values.
template <class T>
class Later {
 public:
  template <class Make>
  const T& get(Make make) const {
    const std::lock_guard lock(mutex_);
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
};

struct mmbrdf_prepared {
  mmbrdf_prepared(std::shared_ptr<const Model> of, double wavelength)
      : model(std::move(of)), at(prepare(*model, wavelength)) {}

  std::shared_ptr<const Model> model;
  PreparedModel at;
  Later<PreparedUncertainty> later_uncertainty;
  Later<PreparedAnswers> later_answers;

  bool has_uncertainty() const { return knows_uncertainty(*model); }
  const PreparedUncertainty& uncertainty() const {
    return later_uncertainty.get([&] { return prepare_uncertainty(*model, at.wavelength()); });
  }
  const PreparedAnswers& answers() const {
    return later_answers.get([&] { return Answers(*model, {.parts = false}).at(at.wavelength()); });
  }
};

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A handle for the caller, null unless make() succeeds.
template <class Handle, class Make>
int made(Handle** handle, const char* name, mmbrdf_error* error, Make make) noexcept {
  if (handle) *handle = nullptr;
  return guarded(error, [&] {
    Handle*& to = required(handle, name);
    to = make().release();
  });
}

const std::vector<std::string>& material_names() {
  static const std::vector<std::string> names = materials();
  return names;
}

/// Positions in the table of those with these names; of all, if there are no names.
std::vector<std::size_t> positions(int count, const char* const* names) {
  const std::span<const Quantity> table = quantities(false);  // those that take light come behind them
  if (count < 0 || (!names && static_cast<std::size_t>(count) != table.size()))
    throw std::invalid_argument("count = " + std::to_string(count) + ", must be " +
                                (names ? "0 or more" : std::to_string(table.size()) + " without names"));
  std::vector<std::size_t> result;
  for (int k = 0; k < count; ++k) {
    if (names && quantity(&required(names[k], "name of a quantity")).takes_light)
      throw std::invalid_argument("quantity '" + std::string(names[k]) + "' takes light, which has no place here");
    result.push_back(static_cast<std::size_t>(names ? &quantity(names[k]) - table.data() : k));
  }
  return result;
}

}  // namespace

const char* mmbrdf_version(void) { return MMBRDF_VERSION; }

int mmbrdf_material_count(void) {
  int count = 0;
  guarded(nullptr, [&] { count = static_cast<int>(material_names().size()); });
  return count;
}

const char* mmbrdf_material_name(int number) {
  return number >= 0 && number < mmbrdf_material_count() ? material_names()[static_cast<std::size_t>(number)].c_str()
                                                         : nullptr;
}

int mmbrdf_material(const char* name, mmbrdf_model** model, mmbrdf_error* error) {
  return made(model, "model", error, [&] { return std::make_unique<mmbrdf_model>(material(&required(name, "name"))); });
}

int mmbrdf_load_model(const char* path, mmbrdf_model** model, mmbrdf_error* error) {
  return made(model, "model", error,
              [&] { return std::make_unique<mmbrdf_model>(load_model(&required(path, "path"))); });
}

int mmbrdf_prepare(const mmbrdf_model* model, double wavelength_um, mmbrdf_prepared** prepared, mmbrdf_error* error) {
  return made(prepared, "prepared", error,
              [&] { return std::make_unique<mmbrdf_prepared>(required(model, "model").model, wavelength_um); });
}

void mmbrdf_free_model(mmbrdf_model* model) { delete model; }
void mmbrdf_free_prepared(mmbrdf_prepared* prepared) { delete prepared; }

int mmbrdf_describe(const mmbrdf_model* model, mmbrdf_description* description, mmbrdf_error* error) {
  return guarded(error, [&] {
    const mmbrdf_model& of = required(model, "model");
    const Validity& range = of.model->validity;
    required(description, "description") = {of.model->name.c_str(),
                                            of.basis.c_str(),
                                            of.fitted_range.c_str(),
                                            range.wavelengths.data(),
                                            static_cast<int>(range.wavelengths.size()),
                                            range.theta_i_max.value_or(unknown),
                                            range.theta_r_max.value_or(unknown),
                                            knows_uncertainty(*of.model)};
  });
}

int mmbrdf_layout_from(const char* frame, const char* convention, int order, mmbrdf_layout* layout,
                       mmbrdf_error* error) {
  return guarded(error, [&] {
    const mmbrdf_layout named = {static_cast<int>(frame_from(&required(frame, "frame"))),
                                 static_cast<int>(convention_from(&required(convention, "convention"))), order};
    Layout{&named};  // the order is one
    required(layout, "layout") = named;
  });
}

int mmbrdf_known_elements(const mmbrdf_model* model, const mmbrdf_layout* layout, int known[16], mmbrdf_error* error) {
  return guarded(error, [&] {
    const Layout asked(layout);
    const Elements missing = unknown_elements(*required(model, "model").model, asked.frame);
    required(known, "known");
    for (std::size_t e = 0; e < 16; ++e) known[asked.column_major ? 4 * (e % 4) + e / 4 : e] = !missing[e];
  });
}

int mmbrdf_evaluate(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad,
                    const mmbrdf_layout* layout, int threads, double* matrices, mmbrdf_error* error) {
  return guarded(error, [&] {
    const Layout asked(layout);
    const PreparedModel& model = required(prepared, "prepared").at;
    const auto out = list<Mueller>(matrices, "matrices", n);
    for_geometries(list<const Geometry>(geometries_rad, "geometries_rad", n), threads,
                   [&](std::size_t first, std::span<const Geometry> some) {
                     model.evaluate(some, asked.frame, out.subspan(first, some.size()));
                     asked.apply(out.subspan(first, some.size()), true);
                   });
  });
}

int mmbrdf_standard_uncertainty(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad,
                                const mmbrdf_layout* layout, int threads, double* uncertainties, mmbrdf_error* error) {
  return guarded(error, [&] {
    const Layout asked(layout);
    const mmbrdf_prepared& model = required(prepared, "prepared");
    const auto out = list<Mueller>(uncertainties, "uncertainties", n);
    const PreparedUncertainty* const u = model.has_uncertainty() ? &model.uncertainty() : nullptr;
    for_geometries(list<const Geometry>(geometries_rad, "geometries_rad", n), threads,
                   [&](std::size_t first, std::span<const Geometry> some) {
                     const auto here = out.subspan(first, some.size());
                     if (!u) {
                       for (const Geometry& g : some) require_valid(g);
                       for (Mueller& m : here) m.elements.fill(unknown);
                       return;
                     }
                     u->standard_uncertainty(some, asked.frame, here);
                     asked.apply(here, false);
                   });
  });
}

int mmbrdf_f11(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad, int threads, double* f11,
               mmbrdf_error* error) {
  return guarded(error, [&] {
    const PreparedModel& model = required(prepared, "prepared").at;
    const auto out = list<double>(f11, "f11", n);
    for_geometries(list<const Geometry>(geometries_rad, "geometries_rad", n), threads,
                   [&](std::size_t first, std::span<const Geometry> some) {
                     std::vector<Mueller> matrices(some.size());
                     model.evaluate(some, Frame::xy, matrices);
                     for (std::size_t q = 0; q < some.size(); ++q) out[first + q] = matrices[q](0, 0);
                   });
  });
}

int mmbrdf_outside(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad, int* outside,
                   mmbrdf_error* error) {
  return guarded(error, [&] {
    const PreparedModel& model = required(prepared, "prepared").at;
    const auto out = list<int>(outside, "outside", n);
    for_geometries(list<const Geometry>(geometries_rad, "geometries_rad", n), 1,
                   [&](std::size_t first, std::span<const Geometry> some) {
                     for (std::size_t q = 0; q < some.size(); ++q) {
                       require_valid(some[q]);
                       out[first + q] = static_cast<int>(model.outside(some[q]));
                     }
                   });
  });
}

int mmbrdf_quantity_count(void) { return static_cast<int>(quantities(false).size()); }

int mmbrdf_quantity_at(int number, mmbrdf_quantity* quantity, mmbrdf_error* error) {
  return guarded(error, [&] {
    Layout::require("number", number, mmbrdf_quantity_count() - 1);
    const Quantity& at = quantities(false)[static_cast<std::size_t>(number)];
    required(quantity, "quantity") = {at.name.data(), at.unit.data(), at.meaning.data()};  // literals, they end with 0
  });
}

int mmbrdf_analyze(const mmbrdf_prepared* prepared, int count, const char* const* names, int64_t n,
                   const double* geometries_rad, int threads, double* values, double* uncertainties,
                   mmbrdf_error* error) {
  return guarded(error, [&] {
    const mmbrdf_prepared& model = required(prepared, "prepared");
    const std::vector<std::size_t> asked = positions(count, names);
    const auto geometries = list<const Geometry>(geometries_rad, "geometries_rad", n);
    if (n > 0 && count > 0) required(values, "values");
    const PreparedAnswers& answers = model.answers();
    for_geometries(geometries, threads, [&](std::size_t first, std::span<const Geometry> some) {
      const std::vector<Answer> here = answers.at(some);
      for (std::size_t k = 0; k < asked.size(); ++k)
        for (std::size_t q = 0; q < here.size(); ++q) {
          const Answered& answered = here[q].quantities[asked[k]];
          const std::size_t at = k * geometries.size() + first + q;
          values[at] = answered.value.value_or(unknown);
          if (uncertainties) uncertainties[at] = answered.uncertainty.value_or(unknown);
        }
    });
  });
}

int mmbrdf_dhr(const mmbrdf_prepared* prepared, int64_t n, const double* directions_rad, double* dhr,
               double* uncertainties, mmbrdf_error* error) {
  return guarded(error, [&] {
    const mmbrdf_prepared& model = required(prepared, "prepared");
    const auto directions = list<const Direction>(directions_rad, "directions_rad", n);
    const auto out = list<double>(dhr, "dhr", n);
    for (std::size_t q = 0; q < directions.size(); ++q) {
      require_valid(Geometry{directions[q], {}}, ("direction " + std::to_string(q + 1)).c_str());
      out[q] = directional_hemispherical_reflectance(*model.model, model.at.wavelength(), directions[q]);
    }
    if (!uncertainties) return;
    const auto u = list<double>(uncertainties, "uncertainties", n);
    std::ranges::fill(u, unknown);
    if (model.has_uncertainty()) model.uncertainty().directional_hemispherical_reflectance(directions, u);
  });
}
