// SPDX-License-Identifier: BSD-3-Clause
#include "options/files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <streambuf>
#include <vector>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/formats/foreign.hpp"
#include "mmbrdf/model/description.hpp"
#include "options/arguments.hpp"
#include "options/foreign.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

/// A truncated coefficient file is a valid one, of fewer modes.
void warn_of_missing_elements(const Model& model) {
  Elements there = model.not_measured;  // that is no surprise
  for (const FittedBlock& fitted : model.blocks)
    for (const Element& element : fitted.block.elements) there.set(element.index());
  std::vector<std::string> missing;
  for (std::size_t element = 0; element < 16; ++element)
    if (!there[element]) missing.push_back(element_name(element));
  if (missing.size() == 15) {
    warn("no modes of elements other than 11: they are 0");
  } else if (!missing.empty()) {
    warn("no modes of element" + std::string(missing.size() == 1 ? " " : "s ") + joined(missing) +
         (missing.size() == 1 ? ": it is 0" : ": they are 0"));
  }
}

std::string file_name(const std::string& text) {
  if (text.empty()) throw std::invalid_argument("\"\": expected the name of a file");
  return text;
}

std::string output_file_name(const std::string& text) {
  if (text == "-")
    throw std::invalid_argument("\"-\": expected the name of a file; models do not go to standard output");
  return file_name(text);
}

/// NAME=THEIRS[,NAME=THEIRS…]
ColumnNames column_names_from(const std::string& text) {
  ColumnNames result;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == part.size())
      throw std::invalid_argument("\"" + part + "\": expected NAME=THEIRS, as in theta_i_deg=AOI");
    if (!result.emplace(part.substr(0, equals), part.substr(equals + 1)).second)
      throw std::invalid_argument("\"" + part.substr(0, equals) + "\" is given twice");
  }
  if (result.empty()) throw std::invalid_argument("\"\": expected NAME=THEIRS, as in theta_i_deg=AOI");
  return result;
}

/// Keeps what is read through it.
class Keeping : public std::streambuf {
 public:
  Keeping(std::streambuf& source, std::string& kept) : source_(source), kept_(kept) {}

 private:
  int_type underflow() override {
    const std::streamsize count = source_.sgetn(piece_.data(), static_cast<std::streamsize>(piece_.size()));
    if (count <= 0) return traits_type::eof();
    kept_.append(piece_.data(), static_cast<std::size_t>(count));
    setg(piece_.data(), piece_.data(), piece_.data() + count);
    return traits_type::to_int_type(piece_[0]);
  }

  std::streambuf& source_;
  std::string& kept_;
  std::array<char, 1 << 16> piece_{};
};

std::string model_name(const std::string& text) {
  if (text.empty()) throw std::invalid_argument("\"\": expected a built-in name or a file");
  return text;
}

}  // namespace

std::string base_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

bool is_built_in(const std::string& name) {
  const std::vector<std::string> names = materials();
  return std::find(names.begin(), names.end(), name) != names.end();
}

Model open_model(const std::string& name, std::string* bytes) {
  if (!is_built_in(name) && !std::filesystem::exists(name))
    throw std::runtime_error(name + ": no such file, and not a built-in model (" + joined(materials()) + ")");
  if (is_foreign(name))
    throw std::runtime_error(name + ": is " + foreign_format(name) + ", no model; mmbrdf convert " + shown_name(name) +
                             " OUT.csv makes samples of it, and mmbrdf fit a model of them");
  const std::string text = is_built_in(name) ? "" : model_text(name);
  Model model = is_built_in(name) ? material(name) : model_from_text(text, name);
  warn_of_missing_elements(model);
  if (bytes != nullptr) *bytes = text;
  return model;
}

bool is_samples(const std::string& name) {
  return name == "-" || (!is_built_in(name) && std::filesystem::exists(name) && holds_samples(name));
}

std::string data_name(const std::string& path) { return path == "-" ? "standard input" : base_name(path); }

namespace {

/// Of a stream, which is `path`.
SaidOfTable read_samples_of(std::istream& in, const std::string& name, const std::string& path,
                            const std::optional<std::vector<double>>& wavelengths_nm, const SampleTable& table,
                            const std::function<void(std::span<const Sample>)>& use) {
  constexpr std::size_t some =
      8192;  // the published data come in one piece, so that their wavelengths are folded together
  const std::vector<double> wanted = micrometres(wavelengths_nm.value_or(std::vector<double>{}));
  std::set<double> there;
  std::vector<Sample> samples;
  SampleReader reader(in, name, table);
  for (Sample sample; reader.next(sample);) {
    there.insert(sample.wavelength);
    const auto is_it = [&](double wavelength) { return same_wavelength(wavelength, sample.wavelength); };
    if (wanted.empty() || std::any_of(wanted.begin(), wanted.end(), is_it)) samples.push_back(sample);
    if (samples.size() == some) {
      use(samples);
      samples.clear();
    }
  }
  const SaidOfTable said{reader.understood(), reader.reduction()};
  use(samples);
  for (const double wavelength : wanted) {
    if (std::none_of(there.begin(), there.end(), [&](double one) { return same_wavelength(one, wavelength); })) {
      throw std::runtime_error(data_name(path) + ": has samples at " +
                               nanometre_list(std::vector<double>(there.begin(), there.end())) + ", not at all of " +
                               nanometre_list(wanted));
    }
  }
  if (!said.understood.empty()) note(data_name(path) + ": " + said.understood);
  return said;
}

}  // namespace

SaidOfTable read_samples_at(const std::string& path, const std::optional<std::vector<double>>& wavelengths_nm,
                            const SampleTable& table, const std::function<void(std::span<const Sample>)>& use) {
  SaidOfTable said;
  read_input(path, [&](std::istream& in, const std::string& name) {
    said = read_samples_of(in, name, path, wavelengths_nm, table, use);
  });
  return said;
}

std::vector<Sample> samples_at(const std::string& path, const std::optional<std::vector<double>>& wavelengths_nm,
                               const SampleTable& table, std::string* bytes) {
  std::vector<Sample> all;
  const auto use = [&](std::span<const Sample> samples) { all.insert(all.end(), samples.begin(), samples.end()); };
  if (bytes == nullptr) {
    read_samples_at(path, wavelengths_nm, table, use);
    return all;
  }
  read_input(path, [&](std::istream& in, const std::string& name) {
    Keeping keeping(*in.rdbuf(), *bytes);
    std::istream kept(&keeping);
    read_samples_of(kept, name, path, wavelengths_nm, table, use);
  });
  return all;
}

void require_kept(const std::string& input, const std::string& output, const std::string& what) {
  const std::string source = input == "-" ? "/dev/stdin" : input;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(output, ignored) && std::filesystem::equivalent(source, output, ignored))
    throw std::invalid_argument(output + ": would overwrite the " + what);
}

void require_model_kept(const std::string& model, const std::string& output) {
  if (!is_built_in(model))
    require_kept(model == "-" ? "./-" : model, output, "model");  // a model is never standard input
}

void save(const Model& model, const std::string& path) {
  try {
    save_model(path, model);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  note_written(path);
  if (is_built_in(path)) warn("a built-in model has the name " + path + " and comes first; the file is ./" + path);
}

void read_input(const std::string& path, const std::function<void(std::istream&, const std::string&)>& read) {
  if (path == "-") return read(std::cin, "standard input");
  std::ifstream file = open_input(path);
  read(file, path);
}

void warn_of_what_is_left_out(const Model& model, const std::string& path, bool named) {
  const auto lost_by = model_format(path).lost;
  if (lost_by == nullptr) return;
  std::vector<std::string> lost = lost_by(model);
  for (std::string& what : lost) {
    if (what == "how azimuths enter") what += " (ask it with --as-printed)";
    if (what.starts_with("the reflectance "))
      what += " (keep it: --reflectance " + reflectance_line(model.reflectance) + ")";
  }
  if (named) lost.insert(lost.begin(), "the name");
  if (!lost.empty()) warn(base_name(path) + " has no place for: " + joined(lost));
  if (model.family == Family::isotropic)
    note("SCATMECH and MIST take " + base_name(path) +
         " as printed, which is this model for light from azimuth 0: turn azimuths there, not the sample");
}

Option add_file(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                const std::string& description) {
  return add_option(app, names, target, file_name, shown, description);
}

Option add_output_file(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                       const std::string& description) {
  return add_option(app, names, target, output_file_name, shown, description);
}

bool is_standard_output(const std::string& output) { return output.empty() || output == "-"; }

void write_output(const std::string& output, const std::function<void(std::ostream&)>& write) {
  if (is_standard_output(output)) return write(std::cout);
  write_file(output, write);
  note_written(output);
}

void write_text(const std::string& output, const std::string& text) {
  write_output(output, [&](std::ostream& out) { out << text; });
}

void add_table_options(CLI::App& app, SampleTable& table) {
  add_option(app, "--columns", table.columns, column_names_from, "NAME=THEIRS[,...]",
             "What columns of DATA.csv are that have other names, as\nin theta_i_deg=AOI,f11=BRDF; or their numbers, "
             "from 1");
  add_flag(app, "--skip-incomplete", table.skip_incomplete,
           "Pass over rows with NA or NaN, or without an angle or\nwavelength, and say how many");
  add_option(app, "--frame", table.frame, frame_from, "FRAME",
             "In which the matrices of DATA.csv are: xy, sp or\nscattering_plane [as its column frame says, or xy; sp "
             "of\nf_ss ... f_pp]");
  add_option(app, "--convention", table.convention, convention_from, "NAME",
             "Signs of their Stokes vectors: germer2017,\ns_first_right, p_first_left, p_first_right ... "
             "[germer2017]");
}

std::string table_words(const SampleTable& table) {
  std::string columns, text;
  for (const auto& [own, theirs] : table.columns) columns += (columns.empty() ? "" : ",") + own + "=" + theirs;
  if (!columns.empty()) text += " --columns " + shell_quoted(columns);
  if (table.skip_incomplete) text += " --skip-incomplete";
  if (table.frame) text += " --frame " + to_string(*table.frame);
  if (table.convention != SampleTable{}.convention) text += " --convention " + to_string(table.convention);
  return text;
}

Option add_model(CLI::App& app, std::string& target, const std::string& name) {
  return add_option(app, name, target, model_name, " ", "Built-in name, JSON model or coefficient CSV").required();
}

}  // namespace mmbrdf::program
