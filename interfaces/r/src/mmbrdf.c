/* SPDX-License-Identifier: BSD-3-Clause */
/* R's vectors in degrees and nanometres become what mmbrdf.h takes; NaN becomes NA, a failure an R error. */
#include <mmbrdf.h>
#define R_NO_REMAP
#include <R.h>
#include <R_ext/Rdynload.h>
#include <Rinternals.h>

static void check(int code, const mmbrdf_error* error) {
  if (code != MMBRDF_OK) Rf_error("%s", error->message);
}

static const char* text(SEXP given, const char* name) {
  if (TYPEOF(given) != STRSXP || XLENGTH(given) != 1 || STRING_ELT(given, 0) == NA_STRING)
    Rf_error("%s must be one text", name);
  return Rf_translateCharUTF8(STRING_ELT(given, 0));
}

/* ---- handles ------------------------------------------------------------------------------------------------------*/

static void free_model(SEXP pointer) {
  mmbrdf_free_model(R_ExternalPtrAddr(pointer));
  R_ClearExternalPtr(pointer);
}

static void free_prepared(SEXP pointer) {
  mmbrdf_free_prepared(R_ExternalPtrAddr(pointer));
  R_ClearExternalPtr(pointer);
}

static mmbrdf_model* model_of(SEXP given) {
  if (TYPEOF(given) != EXTPTRSXP || !Rf_inherits(given, "mmbrdf_model"))
    Rf_error("model must be one of material() or load_model()");
  if (!R_ExternalPtrAddr(given)) Rf_error("model was saved with a session of R: load it anew");
  return R_ExternalPtrAddr(given);
}

static SEXP model_from(int (*load)(const char*, mmbrdf_model**, mmbrdf_error*), const char* name) {
  mmbrdf_error error;
  mmbrdf_model* model;
  SEXP result = PROTECT(R_MakeExternalPtr(NULL, R_NilValue, R_NilValue));
  R_RegisterCFinalizerEx(result, free_model, TRUE);
  check(load(name, &model, &error), &error);
  R_SetExternalPtrAddr(result, model);
  Rf_setAttrib(result, R_ClassSymbol, Rf_mkString("mmbrdf_model"));
  UNPROTECT(1);
  return result;
}

static SEXP material(SEXP name) { return model_from(mmbrdf_material, text(name, "name")); }
static SEXP load_model(SEXP path) { return model_from(mmbrdf_load_model, text(path, "path")); }

/* The caller protects it as long as it uses what it points to. */
static SEXP prepared_at(SEXP model, SEXP wavelength_nm) {
  mmbrdf_error error;
  mmbrdf_prepared* prepared;
  const double wavelength_um = Rf_asReal(wavelength_nm) / 1000;
  SEXP result = PROTECT(R_MakeExternalPtr(NULL, R_NilValue, R_NilValue));
  R_RegisterCFinalizerEx(result, free_prepared, TRUE);
  check(mmbrdf_prepare(model_of(model), wavelength_um, &prepared, &error), &error);
  R_SetExternalPtrAddr(result, prepared);
  UNPROTECT(1);
  return result;
}

/* ---- numbers in and out -------------------------------------------------------------------------------------------*/

/* Elements first ... first + n - 1 of vectors of one length, as the library takes them: one geometry, or direction, behind
 * the other. */
static void convert(const SEXP* degrees, int count, R_xlen_t first, R_xlen_t n, double* radians) {
  const double radian = 3.14159265358979323846 / 180;
  for (int c = 0; c < count; ++c) {
    const double* from = REAL(degrees[c]) + first;
    for (R_xlen_t q = 0; q < n; ++q) radians[count * q + c] = from[q] * radian;
  }
}

static double* radians(const SEXP* degrees, int count) {
  const R_xlen_t n = XLENGTH(degrees[0]);
  double* result = (double*)R_alloc((size_t)n * (size_t)count, sizeof(double));
  convert(degrees, count, 0, n, result);
  return result;
}

static void nan_to_na(double* values, R_xlen_t count) {
  for (R_xlen_t i = 0; i < count; ++i)
    if (ISNAN(values[i])) values[i] = NA_REAL;
}

static SEXP names_from(const char* first, const char* second, const char* third) {
  const char* names[] = {first, second, third};
  const int count = third ? 3 : 2;
  SEXP result = PROTECT(Rf_allocVector(STRSXP, count));
  for (int i = 0; i < count; ++i) SET_STRING_ELT(result, i, Rf_mkChar(names[i]));
  UNPROTECT(1);
  return result;
}

typedef int (*of_matrices)(const mmbrdf_prepared*, int64_t, const double*, const mmbrdf_layout*, int, double*,
                           mmbrdf_error*);

static SEXP matrices(of_matrices ask, SEXP model, SEXP wavelength_nm, const SEXP* degrees, SEXP frame, SEXP convention,
                     SEXP threads) {
  mmbrdf_error error;
  mmbrdf_layout layout;
  check(mmbrdf_layout_from(text(frame, "frame"), text(convention, "convention"), MMBRDF_COLUMN_MAJOR, &layout, &error),
        &error);
  const R_xlen_t n = XLENGTH(degrees[0]);
  SEXP prepared = PROTECT(prepared_at(model, wavelength_nm));
  SEXP result = PROTECT(Rf_allocVector(REALSXP, 16 * n));
  SEXP dim = PROTECT(Rf_allocVector(INTSXP, 3));
  INTEGER(dim)[0] = INTEGER(dim)[1] = 4;
  INTEGER(dim)[2] = (int)n;
  const int asked = Rf_asInteger(threads);
  /* In pieces that stay in the cache: new memory for all would take longer than to compute. */
  enum { most = 65536 };
  double* some = (double*)R_alloc(4 * (size_t)(n < most ? n : most), sizeof(double));
  for (R_xlen_t first = 0; first < n; first += most) {
    const R_xlen_t count = n - first < most ? n - first : most;
    convert(degrees, 4, first, count, some);
    if (ask(R_ExternalPtrAddr(prepared), count, some, &layout, asked, REAL(result) + 16 * first, &error))
      check(ask(R_ExternalPtrAddr(prepared), n, radians(degrees, 4), &layout, asked, REAL(result), &error),
            &error); /* which of all is wrong */
  }
  int known[16], all = 1;
  check(mmbrdf_known_elements(model_of(model), &layout, known, &error), &error);
  for (int e = 0; e < 16; ++e) all &= known[e];
  if (!all || (n > 0 && ISNAN(REAL(result)[0]))) nan_to_na(REAL(result), 16 * n);
  Rf_setAttrib(result, R_DimSymbol, dim);
  UNPROTECT(3);
  return result;
}

static SEXP evaluate(SEXP model, SEXP wavelength_nm, SEXP ti, SEXP pi, SEXP tr, SEXP pr, SEXP frame, SEXP convention,
                     SEXP threads) {
  const SEXP degrees[4] = {ti, pi, tr, pr};
  return matrices(mmbrdf_evaluate, model, wavelength_nm, degrees, frame, convention, threads);
}

static SEXP uncertainty(SEXP model, SEXP wavelength_nm, SEXP ti, SEXP pi, SEXP tr, SEXP pr, SEXP frame, SEXP convention,
                        SEXP threads) {
  const SEXP degrees[4] = {ti, pi, tr, pr};
  return matrices(mmbrdf_standard_uncertainty, model, wavelength_nm, degrees, frame, convention, threads);
}

static SEXP outside(SEXP model, SEXP wavelength_nm, SEXP ti, SEXP pi, SEXP tr, SEXP pr) {
  mmbrdf_error error;
  const SEXP degrees[4] = {ti, pi, tr, pr};
  const R_xlen_t n = XLENGTH(ti);
  SEXP prepared = PROTECT(prepared_at(model, wavelength_nm));
  SEXP result = PROTECT(Rf_allocVector(INTSXP, n));
  check(mmbrdf_outside(R_ExternalPtrAddr(prepared), n, radians(degrees, 4), INTEGER(result), &error), &error);
  UNPROTECT(2);
  return result;
}

/* A list of columns: of each quantity, and u_ of each. */
static SEXP analyze(SEXP model, SEXP wavelength_nm, SEXP ti, SEXP pi, SEXP tr, SEXP pr, SEXP names, SEXP threads) {
  mmbrdf_error error;
  const SEXP degrees[4] = {ti, pi, tr, pr};
  const R_xlen_t n = XLENGTH(ti);
  if (TYPEOF(names) != STRSXP) Rf_error("names must be texts");
  const int count = (int)XLENGTH(names);
  const char** asked = (const char**)R_alloc((size_t)count, sizeof(char*));
  for (int k = 0; k < count; ++k) asked[k] = Rf_translateCharUTF8(STRING_ELT(names, k));
  double* values = (double*)R_alloc((size_t)count * (size_t)n, sizeof(double));
  double* u = (double*)R_alloc((size_t)count * (size_t)n, sizeof(double));
  SEXP prepared = PROTECT(prepared_at(model, wavelength_nm));
  check(mmbrdf_analyze(R_ExternalPtrAddr(prepared), count, asked, n, radians(degrees, 4), Rf_asInteger(threads), values,
                       u, &error),
        &error);
  SEXP result = PROTECT(Rf_allocVector(VECSXP, 2 * count));
  SEXP columns = PROTECT(Rf_allocVector(STRSXP, 2 * count));
  for (int k = 0; k < 2 * count; ++k) {
    char name[100];
    snprintf(name, sizeof name, "%s%s", k < count ? "" : "u_", asked[k % count]);
    SET_STRING_ELT(columns, k, Rf_mkChar(name));
    SET_VECTOR_ELT(result, k, Rf_allocVector(REALSXP, n));
    double* column = REAL(VECTOR_ELT(result, k));
    for (R_xlen_t q = 0; q < n; ++q) column[q] = (k < count ? values : u)[(k % count) * n + q];
    nan_to_na(column, n);
  }
  Rf_setAttrib(result, R_NamesSymbol, columns);
  UNPROTECT(3);
  return result;
}

static SEXP dhr(SEXP model, SEXP wavelength_nm, SEXP theta_i, SEXP phi_i) {
  mmbrdf_error error;
  const SEXP degrees[2] = {theta_i, phi_i};
  const R_xlen_t n = XLENGTH(theta_i);
  SEXP prepared = PROTECT(prepared_at(model, wavelength_nm));
  SEXP result = PROTECT(Rf_allocVector(VECSXP, 2));
  SET_VECTOR_ELT(result, 0, Rf_allocVector(REALSXP, n));
  SET_VECTOR_ELT(result, 1, Rf_allocVector(REALSXP, n));
  double* u = REAL(VECTOR_ELT(result, 1));
  check(mmbrdf_dhr(R_ExternalPtrAddr(prepared), n, radians(degrees, 2), REAL(VECTOR_ELT(result, 0)), u, &error),
        &error);
  nan_to_na(u, n);
  Rf_setAttrib(result, R_NamesSymbol, names_from("dhr", "u_dhr", NULL));
  UNPROTECT(2);
  return result;
}

/* ---- what there is ------------------------------------------------------------------------------------------------*/

static SEXP materials(void) {
  const int count = mmbrdf_material_count();
  SEXP result = PROTECT(Rf_allocVector(STRSXP, count));
  for (int i = 0; i < count; ++i) SET_STRING_ELT(result, i, Rf_mkChar(mmbrdf_material_name(i)));
  UNPROTECT(1);
  return result;
}

static SEXP quantities(void) {
  const int count = mmbrdf_quantity_count();
  SEXP result = PROTECT(Rf_allocVector(VECSXP, 3));
  for (int c = 0; c < 3; ++c) SET_VECTOR_ELT(result, c, Rf_allocVector(STRSXP, count));
  for (int k = 0; k < count; ++k) {
    mmbrdf_error error;
    mmbrdf_quantity quantity;
    check(mmbrdf_quantity_at(k, &quantity, &error), &error);
    SET_STRING_ELT(VECTOR_ELT(result, 0), k, Rf_mkChar(quantity.name));
    SET_STRING_ELT(VECTOR_ELT(result, 1), k, Rf_mkChar(quantity.unit));
    SET_STRING_ELT(VECTOR_ELT(result, 2), k, Rf_mkCharCE(quantity.meaning, CE_UTF8));
  }
  Rf_setAttrib(result, R_NamesSymbol, names_from("name", "unit", "meaning"));
  UNPROTECT(1);
  return result;
}

static SEXP describe(SEXP model) {
  mmbrdf_error error;
  mmbrdf_description said;
  check(mmbrdf_describe(model_of(model), &said, &error), &error);
  const char* names[] = {"name", "basis", "fitted_range", "has_uncertainty", ""};
  SEXP result = PROTECT(Rf_mkNamed(VECSXP, names));
  SET_VECTOR_ELT(result, 0, Rf_mkString(said.name));
  SET_VECTOR_ELT(result, 1, Rf_mkString(said.basis));
  SET_VECTOR_ELT(result, 2, Rf_mkString(said.fitted_range));
  SET_VECTOR_ELT(result, 3, Rf_ScalarLogical(said.has_uncertainty));
  UNPROTECT(1);
  return result;
}

static SEXP known_elements(SEXP model, SEXP frame) {
  mmbrdf_error error;
  mmbrdf_layout layout;
  check(mmbrdf_layout_from(text(frame, "frame"), "germer2017", MMBRDF_COLUMN_MAJOR, &layout, &error), &error);
  SEXP result = PROTECT(Rf_allocMatrix(LGLSXP, 4, 4));
  check(mmbrdf_known_elements(model_of(model), &layout, LOGICAL(result), &error), &error);
  UNPROTECT(1);
  return result;
}

#define ENTRY(name, arguments) \
  { #name, (DL_FUNC)(void (*)(void)) & name, arguments }
static const R_CallMethodDef entries[] = {
    ENTRY(materials, 0),      ENTRY(material, 1),   ENTRY(load_model, 1), ENTRY(describe, 1),
    ENTRY(known_elements, 2), ENTRY(quantities, 0), ENTRY(evaluate, 9),   ENTRY(uncertainty, 9),
    ENTRY(analyze, 8),        ENTRY(outside, 6),    ENTRY(dhr, 4),        {NULL, NULL, 0}};

void R_init_mmbrdf(DllInfo* library) {
  R_registerRoutines(library, NULL, entries, NULL, NULL);
  R_useDynamicSymbols(library, FALSE);
}
