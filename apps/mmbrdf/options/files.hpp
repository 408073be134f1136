// SPDX-License-Identifier: BSD-3-Clause
// The files that the program reads and writes, and what it says about them.
#pragma once

#include <functional>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "options/option.hpp"

namespace mmbrdf::program {

/// The last part of a path.
std::string base_name(const std::string& path);

/// Whether this is the name of a built-in model, which comes before a file of that name.
bool is_built_in(const std::string& name);

/// A built-in model, or one from a file. Warns of elements without modes. `bytes` becomes what the file held, nothing for a
/// built-in one.
Model open_model(const std::string& name, std::string* bytes = nullptr);

/// Whether this is a file of samples and no model: neither a built-in one, nor JSON, nor rows of numbers without a
/// header. "-" is standard input, which is samples. Throws std::runtime_error for a file that cannot be read.
bool is_samples(const std::string& name);

/// Calls `read` with a file, or with standard input for "-", and its name for messages.
void read_input(const std::string& path, const std::function<void(std::istream&, const std::string&)>& read);

/// What a data file is called in messages and provenance: the last part of its path, or "standard input" for "-".
std::string data_name(const std::string& path);

/// Of a table of samples, for the provenance of models.
struct SaidOfTable {
  std::string understood;  ///< what is not as in the project's own
  std::string reduction;   ///< from which readings, and how, if the table says it
};

/// Hands over the samples of these wavelengths (nm; none given: of all), a few thousand at a time. Returns what the table
/// says, after a note of what is not as in the project's own. Throws std::runtime_error if there are none at one of them.
SaidOfTable read_samples_at(const std::string& path, const std::optional<std::vector<double>>& wavelengths_nm,
                            const SampleTable& table, const std::function<void(std::span<const Sample>)>& use);

/// The same, in memory. `bytes` becomes what the file held.
std::vector<Sample> samples_at(const std::string& path, const std::optional<std::vector<double>>& wavelengths_nm,
                               const SampleTable& table, std::string* bytes = nullptr);

/// --columns, --skip-incomplete, --frame, --convention
void add_table_options(CLI::App& app, SampleTable& table);

/// These options, each after a blank, as one would type them; what is as it is without them is left out.
std::string table_words(const SampleTable& table);

/// Throws std::invalid_argument if writing `output` would overwrite `input`, under whatever names and links. "-" is
/// standard input. `what` names the input in the message.
void require_kept(const std::string& input, const std::string& output, const std::string& what);

/// The same for a model, which may be a built-in one: those are no files.
void require_model_kept(const std::string& model, const std::string& output);

/// Writes a model; warns if its path is the name of a built-in one. Errors name the path.
void save(const Model& model, const std::string& path);

/// Warns, in one line, of all that is known about `model` and has no place in the format of `path`, and notes in another
/// how others turn an isotropic one. `named`: the name was given by hand.
void warn_of_what_is_left_out(const Model& model, const std::string& path, bool named);

// Options that are files. An empty name is wrong usage.

Option add_file(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                const std::string& description);

/// The same, where "-" is wrong usage, too: standard output is for something else.
Option add_output_file(CLI::App& app, const std::string& names, std::string& target, const std::string& shown,
                       const std::string& description);

/// "-" is standard output.
bool is_standard_output(const std::string& output);

/// On standard output or in a file, which appears when it is complete.
void write_output(const std::string& output, const std::function<void(std::ostream&)>& write);

/// The same of a text.
void write_text(const std::string& output, const std::string& text);

Option add_model(CLI::App& app, std::string& target, const std::string& name = "MODEL");

}  // namespace mmbrdf::program
