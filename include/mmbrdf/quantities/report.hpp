// SPDX-License-Identifier: BSD-3-Clause
/// What a model is and how far it can be trusted: all that can be said of it, and of samples beside it, as JSON text
/// for programs that show it. `mmbrdf report` prints it as Markdown.
///
/// The text is one object in one line. Its fields come in this order, and so do those of their rows; a row is an
/// object, and all rows of a field have the same names:
///
///   title                 "Report on" and shown_name_of() the model
///   warnings              sentences, without a full stop; none if there is nothing to be wary of within the fitted range
///   notes                 the same of what is only to be noted: beyond that range, between wavelengths, not to be told
///   model                 name, basis and fitted range in words, reflectance table if there is one; then what the
///                         provenance says, with its own names, or "provenance: name" where one of those is taken
///   fit                   row by block: block, coefficients, rank, condition, covariance (true or false: known)
///   sample                of a posterior, row by wavelength and block: wavelength_nm, block, noise, once_per_turn,
///                         twice_per_turn, thrice_per_turn, nonreciprocal (sample_traits)
///   realizability         row by wavelength and largest polar angle, the fitted one where it is known and 90 degrees:
///                         wavelength_nm, theta_max_deg, geometries, unrealizable, smallest_margin, u_margin, margin_at,
///                         f11_not_positive, smallest_f11, u_smallest_f11, largest_dhr, u_largest_dhr,
///                         dhr_at_theta_i_deg (model_diagnostics)
///   uncertainty           what u holds, in words (uncertain_of), or "not known"
///   terms                 where some are given, row by term: cause, kind ("scale", "theta_i_deg", … "calibration"), u,
///                         degrees_of_freedom
///   reflectances          row by wavelength and quantity: wavelength_nm, quantity, value, u, validity (to_string(Outside)).
///                         Quantities are "dhr, theta_i 0", 8, 45, 60 and 75 degrees, "bhr", "reflectance factor 0:45" and
///                         "… 45:0"
///   budgets               row by wavelength, quantity ("dhr, theta_i 8" and "reflectance factor 0:45") and cause, the last
///                         "together": wavelength_nm, quantity, cause, u, degrees_of_freedom (null: infinite), U (of
///                         "together" reported_coverage u, else null); none where u is not known
///
/// and with samples also
///
///   data                  name, samples, wavelengths in words, and which of the following is of which model
///   directions            for pictures: wavelengths_nm; grid, whether there are 50 samples or more for each direction of
///                         the source; phi_i_deg, the azimuth of most sources if so, else 180; theta_i_deg, the smallest, a
///                         middle and the largest angle of incidence there at the middle one of the wavelengths
///   residuals             samples − model: a row for f11 in sr⁻¹, one for f11 relative to f11, one for each of the 15
///                         other elements: element ("11" … "44"), unit ("sr^-1" or "f11"), rms, mean, largest,
///                         wavelength_nm, at (compare)
///   chi_squared           row by block, and one of all but 11: block, degrees_of_freedom, chi_squared_per_dof of a fit
///                         weighted by the uncertainties of the samples; where not all are known, a sentence
///   conventions           row by what the samples may be read as, first as their file declares: read_as, rms
///                         (convention_fits)
///   reciprocity           row by block: block, rows, more_coefficients, rms, rms_without, F, p (symmetry_tests);
///   mirror_symmetry       rows as for reciprocity; rms_without is what is left without the symmetry
///   dependence_on_phi_i   rows as for reciprocity, without isotropy; where the source has one azimuth in the samples,
///                         the sentence that says so
///   noise                 row by wavelength whose law is known: wavelength_nm, scale, u_scale, exponent_cos_theta_i,
///                         u_exponent_i, exponent_cos_theta_r, u_exponent_r (estimate_noise)
///   repeats               row by block: block, repeats, pure_error, misfit, F, p (lack_of_fit); where no geometry was
///                         measured twice, a sentence
///   leverage              row by block: block, rank, largest_leverage, sample, at (sample_diagnostics)
///   outliers              row by element of a sample, the largest first and at most listed_outliers: sample, element,
///                         studentized, wavelength_nm, at
///
/// A field u, or u_ and more, is the standard uncertainty of the one before it. Samples are numbered from 1. Numbers
/// are those of the functions named, and read back to the same bits. null stands for what is not known: the rank and
/// condition of a fit, an uncertainty u, the wavelength of a model that does not depend on it and does not say to which
/// it was fitted; and for a number that is not finite. A place, margin_at or at, is "theta_i 45, theta_r 60, phi_r -
/// phi_i 90 degrees". Bytes of names that are not UTF-8 become U+FFFD.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/notation.hpp"
#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

/// A symmetry is said to be broken where p is below the first, and the rms without it is smaller by more than this part
/// of itself: the F test alone finds the least misfit of thousands of rows significant.
inline constexpr double significant_p = 1e-3, noticeable_fall = 0.05;

/// A sample whose leverage exceeds this is said to decide a block almost alone where it is.
inline constexpr double high_leverage = 0.5;

/// Elements of samples beyond this many standard deviations are outliers; warnings say how many there are.
inline constexpr double outlier_threshold = 5;
inline constexpr std::size_t listed_outliers = 20;

/// k of the expanded uncertainties of a report.
inline constexpr double reported_coverage = 2;

/// Samples to set beside a model, and what they are called.
struct ReportedSamples {
  std::string name;
  std::span<const Sample> samples;
};

/// How reports and pictures name a model that was called `name`: so, and by its own name in brackets where that is another,
/// "plaque.json (ptfe)". That of its file without the ending is not.
std::string shown_name_of(const Model& model, const std::string& name);

/// Of the model called `name`, at these wavelengths (micrometres); none given: at known_wavelengths(model). Residuals
/// and noise are those of the model as it is; chi^2, conventions, symmetries, leverage and outliers are of fits of its
/// basis to the samples, without weights but for chi^2. `terms` are of all u of reflectances and of the extremes of
/// realizability, which have none at the horizon of the receiver with a term theta_r. Throws std::invalid_argument for an invalid
/// model or wavelength, if there is no wavelength to report on, for samples as compare(), symmetry_tests() and fit() do,
/// and for terms where the uncertainty of the model is not known.
std::string report_json(const Model& model, const std::string& name, std::span<const double> wavelengths = {},
                        const std::optional<ReportedSamples>& samples = {}, std::span<const TypeBTerm> terms = {});

/// Where a report comes from: nothing of it is looked up.
struct ReportOrigin {
  struct File {
    std::string what;    ///< "model", "data"
    std::string name;    ///< without its folder
    std::string sha256;  ///< empty: not known
  };
  std::string date, software, command;  ///< as they are to be printed; empty ones are left out
  std::vector<File> files{};
  std::string model = "MODEL";    ///< in the commands that draw its pictures: words of a shell
  std::string data = "DATA.csv";  ///< likewise, with the options with which its table was read
};

struct ReportStyle {
  Notation notation = Notation::brackets;
  double theta_i_deg = 45;  ///< of the pictures of the model
};

/// The report as a document for people, as JSON text: title, and blocks one behind the other, each an object with its
/// kind and
///
///   summary     subject, text: the first sentence
///   warnings    lines: sentences, none if there is nothing to be wary of
///   notes       the same, of what lies beyond the fitted range or could not be told
///   contents    here stands a list of the headings; lines is empty
///   heading     text, anchor: the name of a link to it
///   paragraph   text
///   table       number, caption, columns (heading, align: "left" or "right"), rows of as many texts, perhaps remark
///   figure      number, caption, plot: a kind of `mmbrdf plot`, of_data: whether it takes the samples too, arguments as
///               mmbrdf.plot has them, width_cm, and command, which draws it
///
/// Numbers are text, with no more digits than their uncertainties leave (notation.hpp). `report_json` is what
/// report_json() gave of the same model. All text may hold what others wrote: it is no markup.
std::string report_document(const Model& model, const std::string& report_json, const ReportOrigin& origin = {},
                            const ReportStyle& style = {});

/// Such a document as Markdown (GitHub's, for its tables); pictures are the commands that draw them.
std::string report_markdown(const std::string& document);

}  // namespace mmbrdf
