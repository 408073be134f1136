// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf convert

#include <algorithm>
#include <cmath>
#include <memory>

#include "command.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/formats/projection.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "options/arguments.hpp"
#include "options/certificate.hpp"
#include "options/files.hpp"
#include "options/foreign.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string input, output, name, certificate;
  std::optional<Family> family;
  std::optional<Orders> orders;
  std::optional<ReflectanceTable> reflectance;
  std::optional<std::vector<double>> wavelengths_nm;
  std::optional<AnglesDegrees> angles;
};

Family family_to_convert_to(const std::string& name) {
  const Family family = family_from(name);
  if (family == Family::anisotropic) throw std::invalid_argument("\"anisotropic\": expected isotropic or germer2017");
  return family;
}

/// Root mean square of what a conversion changes, over random directions.
struct Change {
  double f11 = 0;  ///< sr⁻¹
  double others = 0;
  double theta_max;
};

Change change(const Model& before, const Model& after) {
  constexpr int count = 2000;
  // Models that do not say where they are valid are compared up to 75 degrees, where published data end.
  constexpr double most = radians(75);
  Change change{.theta_max = std::min(
                    {before.validity.theta_i_max.value_or(most), before.validity.theta_r_max.value_or(most), most})};
  const std::vector<double> wavelengths = known_wavelengths(before);
  for (const double wavelength : wavelengths) {
    const PreparedModel old_model = prepare(before, wavelength), new_model = prepare(after, wavelength);
    for (const Geometry& geometry : random_geometries(count, 1, change.theta_max)) {
      const Mueller f = old_model.evaluate(geometry), g = new_model.evaluate(geometry);
      const Mueller difference = normalized(f) - normalized(g);
      change.f11 += std::pow(f(0, 0) - g(0, 0), 2);
      for (const double m : difference.elements) change.others += std::isnan(m) ? 0 : m * m;
    }
  }
  const auto others = static_cast<double>(std::max<std::size_t>(15 - unknown_elements(before).count(), 1));
  const double geometries = count * static_cast<double>(wavelengths.size());
  change.f11 = std::sqrt(change.f11 / geometries);
  change.others = std::sqrt(change.others / (others * geometries));
  return change;
}

Model in_basis(const Model& model, const Options& options) {
  const Family family = options.family.value_or(options.orders ? Family::isotropic : model.family);
  if (family == Family::isotropic && (options.orders || model.family != Family::isotropic)) {
    Model result = projected_on_isotropic(model, options.orders.value_or(orders(model)));
    if (known_wavelengths(model).empty()) {
      note("projected on the isotropic basis; --wavelength would tell where to see how much that changes");
    } else {
      const Change c = change(model, result);
      note("projected on the isotropic basis: rms change of f11 " + format("%.3g", c.f11) +
           " sr^-1, of the others / f11 " + format("%.3g", c.others) + ", below " +
           format("%.4g", degrees(c.theta_max)) + " degrees");
    }
    return result;
  }
  return family == Family::germer2017 ? in_published_form(model) : model;
}

void record_wavelengths(Model& model, const std::vector<double>& wavelengths_nm) {
  std::vector<double> wavelengths = micrometres(wavelengths_nm);
  std::sort(wavelengths.begin(), wavelengths.end());
  const std::vector<double>& old = model.validity.wavelengths;
  if (!old.empty() && nanometre_list(old) != nanometre_list(wavelengths))
    warn("--wavelength replaces the fitted wavelengths " + nanometre_list(old));
  model.validity.wavelengths = wavelengths;
}

void record_angles(Model& model, const AnglesDegrees& angles) {
  for (const double angle : {angles.theta_i, angles.theta_r}) {
    if (!(angle >= 0 && angle <= 90)) {
      throw std::invalid_argument("--angles " + shortest(angles.theta_i) + "," + shortest(angles.theta_r) +
                                  ": a largest polar angle is not in [0, 90] degrees");
    }
  }
  const Validity old = model.validity;
  model.validity.theta_i_max = radians(angles.theta_i);
  model.validity.theta_r_max = radians(angles.theta_r);
  if (angles_line(old) != "not known" && angles_line(old) != angles_line(model.validity))
    warn("--angles replaces the fitted angles " + angles_line(old));
}

void record_reflectance(Model& model, const ReflectanceTable& table) {
  const std::string old = reflectance_line(model.reflectance);
  if (!old.empty() && old != reflectance_line(table))
    warn("--reflectance replaces the table there was: --reflectance " + old);
  for (const double wavelength : model.validity.wavelengths) require_reaches(table, wavelength);
  model.reflectance = table;
}

void record_certificate(Model& model, const std::string& text) {
  CertifiedModel result = certified(model, certificate_from(text, model.validity));
  if (result.change > noticeable_change)
    warn(
        "the certificate changes f11 by up to " + format("%.1f", 100 * result.change) + " % (at " +
        brief(nanometres(result.wavelength)) +
        " nm); the other elements / f11 stay those of the sample that was measured, and a darker one depolarizes less");
  model = std::move(result.model);
}

void record(Model& model, const Options& options) {
  if (options.wavelengths_nm) record_wavelengths(model, *options.wavelengths_nm);
  if (options.angles) record_angles(model, *options.angles);
  if (options.reflectance) record_reflectance(model, *options.reflectance);
  if (!options.certificate.empty()) record_certificate(model, options.certificate);
}

/// A measurement in another program's format: no model, so what is recorded in one has no place.
void convert_samples(const Options& o) {
  if (o.family || o.orders || o.reflectance || o.angles || !o.certificate.empty() || !o.name.empty())
    throw WrongUsage("convert", o.input + " holds samples: of the options, --wavelength alone goes with them");
  write_as_samples(o.input, o.output, o.wavelengths_nm);
}

void convert(const Options& options, const CommandLine& line) {
  if (is_foreign(options.input)) return convert_samples(options);
  if (options.output == "-")
    throw WrongUsage("OUT", "\"-\": expected the name of a file; models do not go to standard output");
  if (options.orders && options.family == Family::germer2017)
    throw WrongUsage("--orders", "goes with the isotropic basis only");
  require_model_kept(options.input, options.output);
  Model model = open_model(options.input);
  record(model, options);
  Model result = in_basis(model, options);
  result.name = options.name.empty() ? result.name : options.name;
  result.provenance["conversion"] = line.text({options.input, options.output}) + " (" + software() + ")";
  save(result, options.output);
  warn_if_above_one(result, known_wavelengths(result));
  warn_of_what_is_left_out(model, options.output, !options.name.empty());
  if (!model_format(options.output).lost && has_covariance(model) && !has_covariance(result))
    warn("the covariance of the coefficients is not carried over");
}

constexpr const char* footer =
    "IN may also be a measurement in another program's format, told by its content: ASTM E1392 and E2387, Zemax,\n"
    "ALTA, MERL, BiRD JSON, NetCDF, RGL .bsdf, Mitsuba's .pbsdf. OUT.csv is then a table of samples, in this "
    "project's\n"
    "frame (but for samples that would lose elements on the way to it), units and signs; a note says how the file was\n"
    "understood.\n"
    "\n"
    "Of a model, OUT is JSON, or the published coefficient layout if it ends in .csv; isotropic models have that form\n"
    "too, exactly.\n"
    "germer2017 models become isotropic by projection: the nearest model, not the same one; how near is printed.\n"
    "Coefficient files say neither to which wavelengths and angles they were fitted nor by which reflectance f11 was\n"
    "divided: tell it.\n"
    "\n"
    "--certificate rescales f11 so that its directional-hemispherical reflectance at THETA is the certified one, with\n"
    "its standard uncertainty; R is a part of 1. FILE.csv has the columns wavelength_nm, reflectance, u_reflectance "
    "and,\n"
    "unless it is 8, theta_i_deg. Errors of a certificate count as one for all its wavelengths; the model is valid\n"
    "between these. Polarization is not changed, though that of a grey sample differs from that of a white one.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf convert ptfe ptfe.csv\n"
    "  mmbrdf convert goniometer.astm samples.csv --wavelength 633\n"
    "  mmbrdf convert PTFE.coeff.csv ptfe.json --basis isotropic --wavelength 351,532,633,1064 \\\n"
    "      --angles 75,81.87 --reflectance 351:0.976,532:0.984,633:0.984,1064:0.983\n"
    "  mmbrdf convert ptfe plaque.json --certificate 8:443:0.990+-0.004,8:532:0.988+-0.004";

}  // namespace

Run convert_command(CLI::App& app, const CommandLine& line) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->input, "IN")
      .description("Built-in name, JSON model, coefficient CSV, or a\nmeasurement to be made samples");
  add_file(app, "OUT", o->output, " ", "File to write").required();
  add_option(app, "--basis", o->family, family_to_convert_to, "NAME", "isotropic or germer2017 [that of IN]");
  add_option(app, "--orders", o->orders, orders_from, "N,M",
             "Highest radial orders of the isotropic basis, of f11\nand of the other elements [those of IN]");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Record these as the fitted wavelengths, in nm; of a\nmeasurement that does not say them, its own");
  add_option(app, "--angles", o->angles, angles_degrees, "THETA_I,THETA_R",
             "Record these as the largest fitted polar angles, in\ndegrees");
  add_option(app, "--reflectance", o->reflectance, reflectance_from, "NM:R[,...]|FILE",
             "Multiply f11 by these reflectances, each at a\nwavelength in nm, linear between them, in place of the\n"
             "table of IN");
  add_text(app, "--certificate", o->certificate, "THETA:NM:R+-U,...",
           "Rescale f11 to these certified reflectances, or to\nthose of a FILE.csv")
      .excludes("--reflectance");
  add_text(app, "--name", o->name, "NAME", "Name of the model [that of IN]");
  set_footer(app, footer);
  return [o, line] { convert(*o, line); };
}

}  // namespace mmbrdf::program
