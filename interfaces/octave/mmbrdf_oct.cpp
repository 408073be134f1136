// SPDX-License-Identifier: BSD-3-Clause
// The calls of mmbrdf.h for Octave: mmbrdf_oct ("call", arguments...), which the functions beside this file use.
#include <mmbrdf.h>
#include <octave/interpreter.h>
#include <octave/oct.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace {

void check(int code, const mmbrdf_error& error) {
  if (code != MMBRDF_OK) ::error("mmbrdf: %s", error.message);
}

/// A model as a value of Octave, which counts who uses it and frees it after the last.
class octave_mmbrdf_model : public octave_base_value {
 public:
  octave_mmbrdf_model() = default;
  explicit octave_mmbrdf_model(mmbrdf_model* given) : model(given, mmbrdf_free_model) {}

  bool is_defined() const override { return true; }
  void print(std::ostream& os, bool) override { print_raw(os); }
  bool print_name_tag(std::ostream& os, const std::string& name) const override {
    os << name << " = ";
    return false;
  }
  void print_raw(std::ostream& os, bool = false) const override {
    mmbrdf_description said;
    mmbrdf_error e;
    check(mmbrdf_describe(model.get(), &said, &e), e);
    os << said.name << ": " << said.basis << "\nfitted to " << said.fitted_range << "\n";
    if (!said.has_uncertainty) os << "uncertainties are not known\n";
  }

  std::shared_ptr<mmbrdf_model> model;

 private:
  DECLARE_OV_TYPEID_FUNCTIONS_AND_DATA
};

DEFINE_OV_TYPEID_FUNCTIONS_AND_DATA(octave_mmbrdf_model, "mmbrdf_model", "mmbrdf_model")

const mmbrdf_model* model_of(const octave_value& given) {
  if (given.type_id() != octave_mmbrdf_model::static_type_id())
    ::error("mmbrdf: model must be one of mmbrdf_material or mmbrdf_load_model");
  return dynamic_cast<const octave_mmbrdf_model&>(given.get_rep()).model.get();
}

using Prepared = std::unique_ptr<mmbrdf_prepared, decltype(&mmbrdf_free_prepared)>;

/// Octave would take the first of many numbers, and the code of a letter, for the number.
double one_number(const octave_value& given, const char* name) {
  if (!given.isnumeric() || !given.isreal() || given.numel() != 1) ::error("mmbrdf: %s must be one real number", name);
  return given.double_value();
}

int threads_of(const octave_value& given) {
  const double threads = one_number(given, "threads");
  if (!(threads >= 0 && threads <= INT_MAX && threads == std::floor(threads)))
    ::error("mmbrdf: threads = %g, must be a whole number, 0 or more", threads);
  return static_cast<int>(threads);
}

Prepared prepared(const octave_value& model, const octave_value& wavelength_nm) {
  const double wavelength_um = one_number(wavelength_nm, "wavelength_nm") / 1000;
  mmbrdf_prepared* result = nullptr;
  mmbrdf_error e;
  check(mmbrdf_prepare(model_of(model), wavelength_um, &result, &e), e);
  return {result, mmbrdf_free_prepared};
}

octave_value_list load(bool built_in, const octave_value& name) {
  mmbrdf_model* model = nullptr;
  mmbrdf_error e;
  const std::string text = name.xstring_value("mmbrdf: the name must be a text");
  check((built_in ? mmbrdf_material : mmbrdf_load_model)(text.c_str(), &model, &e), e);
  return ovl(octave_value(new octave_mmbrdf_model(model)));
}

/// matrices (model, wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame, convention, threads), of angles of
/// one size. In pieces that stay in the cache: new memory for all would take longer than to compute.
octave_value_list matrices(decltype(&mmbrdf_evaluate) ask, const octave_value_list& args) {
  mmbrdf_layout layout;
  mmbrdf_error e;
  check(mmbrdf_layout_from(args(6).xstring_value("mmbrdf: frame must be a text").c_str(),
                           args(7).xstring_value("mmbrdf: convention must be a text").c_str(), MMBRDF_COLUMN_MAJOR,
                           &layout, &e),
        e);
  const NDArray degrees[4] = {args(2).array_value(), args(3).array_value(), args(4).array_value(),
                              args(5).array_value()};
  const octave_idx_type n = degrees[0].numel();
  const auto radians = [&](octave_idx_type first, octave_idx_type count, std::vector<double>& out) {
    constexpr double radian = 3.14159265358979323846 / 180;
    out.resize(4 * static_cast<std::size_t>(count));
    double* to = out.data();
    for (octave_idx_type q = first; q < first + count; ++q)
      for (const NDArray& angle : degrees) *to++ = angle.data()[q] * radian;
    return out.data();
  };
  NDArray result(dim_vector(4, 4, n));
  const Prepared at = prepared(args(0), args(1));
  const int threads = threads_of(args(8));
  std::vector<double> some;
  constexpr octave_idx_type most = 65536;
  double* const out = result.fortran_vec();
  for (octave_idx_type first = 0; first < n; first += most) {
    const octave_idx_type count = std::min(most, n - first);
    if (ask(at.get(), count, radians(first, count, some), &layout, threads, out + 16 * first, &e))
      check(ask(at.get(), n, radians(0, n, some), &layout, threads, out, &e), e);  // which of all is wrong
  }
  return ovl(result);
}

/// [values, u] (n, count) = analyze (model, wavelength_nm, geometries_rad (4, n), cell of names, threads)
octave_value_list analyze(const octave_value_list& args) {
  const NDArray geometries = args(2).array_value();
  const string_vector names = args(3).xstring_vector_value("mmbrdf: names must be texts");
  std::vector<const char*> pointers;
  std::vector<std::string> texts;
  for (octave_idx_type k = 0; k < names.numel(); ++k) texts.push_back(names(k));
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const octave_idx_type n = geometries.columns();
  Matrix values(n, names.numel()), u(n, names.numel());
  mmbrdf_error e;
  const Prepared at = prepared(args(0), args(1));
  check(mmbrdf_analyze(at.get(), static_cast<int>(pointers.size()), pointers.data(), n, geometries.data(),
                       threads_of(args(4)), values.fortran_vec(), u.fortran_vec(), &e),
        e);
  return ovl(values, u);
}

/// [dhr, u] = dhr (model, wavelength_nm, directions_rad (2, n))
octave_value_list dhr(const octave_value_list& args) {
  const NDArray directions = args(2).array_value();
  const octave_idx_type n = directions.columns();
  RowVector result(n), u(n);
  mmbrdf_error e;
  const Prepared at = prepared(args(0), args(1));
  check(mmbrdf_dhr(at.get(), n, directions.data(), result.fortran_vec(), u.fortran_vec(), &e), e);
  return ovl(result, u);
}

octave_value_list outside(const octave_value_list& args) {
  const NDArray geometries = args(2).array_value();
  int32NDArray result(dim_vector(1, geometries.columns()));
  mmbrdf_error e;
  const Prepared at = prepared(args(0), args(1));
  check(mmbrdf_outside(at.get(), geometries.columns(), geometries.data(), reinterpret_cast<int*>(result.fortran_vec()),
                       &e),
        e);
  return ovl(result);
}

octave_value_list quantities() {
  const int count = mmbrdf_quantity_count();
  Cell names(count, 1);
  for (int k = 0; k < count; ++k) {
    mmbrdf_quantity quantity;
    mmbrdf_error e;
    check(mmbrdf_quantity_at(k, &quantity, &e), e);
    names(k) = quantity.name;
  }
  return ovl(names);
}

}  // namespace

DEFUN_DLD(mmbrdf_oct, args, , "Calls of mmbrdf.h; see mmbrdf_evaluate.") {
  static const bool registered = [] {
    octave_mmbrdf_model::register_type();
    octave::interpreter::the_interpreter()->mlock();  // values of the type may outlive every caller
    return true;
  }();
  (void)registered;
  const std::string call = args.length() > 0 ? args(0).xstring_value("mmbrdf: the call must be a text") : "";
  const octave_value_list rest = args.slice(1, args.length() > 0 ? args.length() - 1 : 0);
  const auto is = [&](const char* name, octave_idx_type count) { return call == name && rest.length() == count; };
  if (is("material", 1)) return load(true, rest(0));
  if (is("load_model", 1)) return load(false, rest(0));
  if (is("evaluate", 9)) return matrices(mmbrdf_evaluate, rest);
  if (is("uncertainty", 9)) return matrices(mmbrdf_standard_uncertainty, rest);
  if (is("analyze", 5)) return analyze(rest);
  if (is("dhr", 3)) return dhr(rest);
  if (is("outside", 3)) return outside(rest);
  if (is("quantities", 0)) return quantities();
  error("mmbrdf_oct: no such call");
}
