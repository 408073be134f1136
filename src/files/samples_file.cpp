// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/samples_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>

#include "files/sample_columns.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/formats/foreign.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::string_view rotation_name = "sample_rotation_deg";
constexpr std::string_view frame_name = "frame";

/// The line of a table's names, as it is known to be read.
void list(std::string& text, const std::string& part) { text += (text.empty() ? "" : ", ") + part; }

/// foreign_format() of what comes, which is still to be read after that; a pipe is not looked at.
std::string format_of(std::istream& in) {
  const std::istream::pos_type begin = in.tellg();
  if (begin == std::istream::pos_type(-1)) return "";
  std::string head(foreign_head, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  in.clear();
  const auto size = static_cast<std::uint64_t>(in.seekg(0, std::ios::end).tellg() - begin);
  in.seekg(begin);
  return foreign_format(head, size);
}

/// Throws if these are no samples but a measurement in a format of other programs.
std::istream& own_table(std::istream& in, const std::string& name) {
  if (const std::string format = format_of(in); !format.empty())
    throw std::runtime_error(name + ": is " + format + ", no table of samples; this makes one of it: mmbrdf convert " +
                             shown_name(name) + " OUT.csv");
  return in;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Whether all samples have uncertainties.
bool have_uncertainties(std::span<const Sample> samples) {
  if (std::ranges::none_of(samples, has_uncertainty, in_own_frame)) return false;
  const auto without = std::ranges::find_if_not(samples, has_uncertainty, in_own_frame);
  if (without != samples.end())
    throw std::invalid_argument("sample " + std::to_string(without - samples.begin() + 1) +
                                " has no uncertainties, but others have");
  return true;
}

}  // namespace

SampleReader::SampleReader(std::istream& in, const std::string& name, const SampleTable& table)
    : name_(name),
      table_(table),
      reader_(own_table(in, name), name, table.columns),
      geometry_(reader_),
      elements_(std::make_unique<ElementColumns>(reader_)),
      rotation_(reader_.find(rotation_name)),
      frame_(table.frame ? -1 : reader_.find(frame_name)) {
  needed_ = geometry_.columns();
  for (const int column : {rotation_, frame_})
    if (column >= 0) needed_.push_back(column);
  read_ = elements_->columns();
  for (std::size_t c = 0; c < reader_.keys().size(); ++c)
    if (static_cast<int>(c) != rotation_ && reader_.keys()[c].find("rotation") != std::string::npos)
      throw reader_.error("column " + shown_name(reader_.columns()[c]) +
                          ": if the sample was turned, call it sample_rotation_deg, in degrees; else leave it out");
  for (const auto& [own, theirs] : table.columns) {
    const int column = reader_.find(own);
    if (std::ranges::find(needed_, column) == needed_.end() && std::ranges::find(read_, column) == read_.end())
      throw reader_.error("column " + shown_name(own) + " = " + shown_name(theirs) + ": " + shown_name(own) +
                          " is no name of a column of samples");
  }
  if (elements_->polarized() && table.frame == Frame::xy)
    throw reader_.error(elements_->polarized_names() + " are of s and p, not of the frame xy");
  if (!table_.frame) table_.frame = elements_->polarized() ? Frame::sp : Frame::xy;
}

SampleReader::~SampleReader() = default;

bool SampleReader::complete() const {
  return std::ranges::none_of(needed_, [&](int column) { return reader_.is_missing(column); }) &&
         elements_->complete(reader_);
}

bool SampleReader::next(Sample& sample) {
  do {
    if (!reader_.next()) {
      if (rows_ == 0)
        throw std::runtime_error(name_ +
                                 (passed_over_ > 0 ? ": no complete row" : ": no samples after the header line"));
      return false;
    }
  } while (table_.skip_incomplete && !complete() && ++passed_over_ > 0);
  ++rows_;
  sample.as_measured.reset();  // that of the row before
  sample.given_in = Frame::xy;
  sample.wavelength = geometry_.wavelength(reader_);
  sample.geometry = geometry_.geometry(reader_);
  elements_->read(reader_, sample);
  if (table_.convention != StokesConvention::germer2017) {
    const Mueller before = sample.normalized;
    sample.normalized = convert(before, table_.convention, StokesConvention::germer2017);
    if (elements_->polarized())  // s is s whatever the convention
      for (const std::size_t e : {1UL, 4UL, 5UL}) sample.normalized.elements[e] = before.elements[e];
  }
  if (const Frame frame = frame_of_row(); frame != Frame::xy) {
    const Elements before = not_measured(sample);
    sample = from_frame(sample, frame);
    if ((not_measured(sample) & ~before).any()) ++lost_;
  }
  if (rotation_ >= 0) sample = turned(sample, -radians(reader_.number(rotation_)));
  return true;
}

Frame SampleReader::frame_of_row() const {
  if (frame_ < 0) return *table_.frame;
  const std::string name(reader_.field(frame_));
  const Frame frame = [&] {
    try {
      return frame_from(name);
    } catch (const std::invalid_argument& error) {
      throw reader_.error("column " + shown_name(reader_.columns()[static_cast<std::size_t>(frame_)]) + ": " +
                          error.what() + "; if it is of something else, say the frame of all rows (--frame)");
    }
  }();
  if (frame == Frame::xy && elements_->polarized())
    throw reader_.error(elements_->polarized_names() + " are of s and p, not of the frame xy");
  return frame;
}

std::string SampleReader::understood() const {
  const TableLayout& layout = reader_.layout();
  std::string text;
  if (layout.separator == ';') list(text, "separated by semicolons");
  if (layout.separator == '\t') list(text, "separated by tabs");
  if (layout.separator == ' ') list(text, "separated by blanks");
  if (layout.decimal == ',') list(text, "decimal commas");
  if (layout.header_comment) list(text, "names in a comment");
  if (layout.row_names) list(text, "row names");
  std::string unread, capital;
  for (std::size_t c = 0; c < reader_.columns().size(); ++c) {
    const std::string &column = reader_.columns()[c], &key = reader_.keys()[c];
    const auto is_it = [&](int other) { return other == static_cast<int>(c); };
    if (std::ranges::none_of(needed_, is_it) && std::ranges::none_of(read_, is_it)) {
      if (!column.empty()) unread += (unread.empty() ? "" : " ") + shown_name(column);
    } else if (lower_case(column) != key) {
      list(text, shown_name(column) + " is " + key);
    } else if (capital.empty() && key.size() == 3 && key[0] == 'm' && column[0] == 'M') {
      capital = column;
    }
  }
  if (!capital.empty()) list(text, capital + " ... are divided by f11");
  if (!elements_->f11_is().empty()) list(text, elements_->f11_is());
  if (frame_ < 0 && table_.frame != Frame::xy) list(text, "frame " + to_string(*table_.frame));
  if (table_.convention != StokesConvention::germer2017) list(text, "convention " + to_string(table_.convention));
  if (!unread.empty()) list(text, "not read: " + unread);
  if (lost_ > 0)
    list(text,
         std::to_string(lost_) + " of " + std::to_string(rows_) +
             " samples have elements that out of plane are unknown in xy, mixed with some that were not measured: "
             "fits in the isotropic basis take them as they were measured");
  if (passed_over_ > 0)
    list(text, std::to_string(passed_over_) + " incomplete row" + (passed_over_ > 1 ? "s" : "") + " passed over");
  return text;
}

std::vector<Sample> read_samples(std::istream& in, const std::string& name, const SampleTable& table) {
  SampleReader reader(in, name, table);
  std::vector<Sample> samples;
  for (Sample sample; reader.next(sample);) samples.push_back(sample);
  return samples;
}

bool holds_samples(const std::string& path) {
  std::ifstream in = open_input(path);
  return holds_samples(in);
}

bool holds_samples(std::istream& in) {
  if (!format_of(in).empty()) return true;  // whoever reads them says what to do
  std::string comment;
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r\xef\xbb\xbf");
    if (first == std::string::npos) continue;
    if (line[first] != '#' && line[first] != '%')
      return std::isalpha(static_cast<unsigned char>(line[first])) != 0 || line[first] == '"' || line[first] == ',' ||
             static_cast<unsigned char>(line[first]) >= 0x80 || lower_case(comment).find("theta") != std::string::npos;
    comment = line;
  }
  return false;
}

std::vector<Sample> read_samples(const std::string& path, const SampleTable& table) {
  std::ifstream in = open_input(path);
  return read_samples(in, path, table);
}

void write_samples(const std::string& path, std::span<const Sample> samples, const std::string& reduction) {
  require_valid(samples);
  write_file(path, [&](std::ostream& out) { write_samples(out, samples, reduction); });
}

SampleWriter::SampleWriter(std::ostream& out, const Elements& measured, bool with_uncertainties, bool with_frames,
                           bool in_micrometres)
    : out_(out),
      written_(measured),
      with_uncertainties_(with_uncertainties),
      with_frames_(with_frames),
      in_micrometres_(in_micrometres) {
  written_.set(0);  // a file needs the column of f11
  out << (in_micrometres ? "wavelength_um" : "wavelength_nm") << ",theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg";
  if (with_frames) out << ',' << frame_name;
  for (const char* prefix : {"", "u_"})
    for (std::size_t e = 0; e < 16 && (*prefix == 0 || with_uncertainties); ++e)
      if (written_[e]) out << ',' << prefix << sample_element(e);
  out << '\n';
}

void SampleWriter::write(std::span<const Sample> samples) {
  for (const Sample& one : samples) {
    if (one.as_measured && !with_frames_)
      throw std::invalid_argument("a sample in another frame than xy, without a column for it");
    const Sample sample = in_own_frame(one);
    const Elements unknown = not_measured(sample);
    out_ << shortest(in_micrometres_ ? sample.wavelength : in_nanometres(sample.wavelength));
    for (const Direction& direction : {sample.geometry.incident, sample.geometry.reflected})
      out_ << ',' << shortest(in_degrees(direction.theta)) << ',' << shortest(in_degrees(direction.phi));
    if (with_frames_) out_ << ',' << to_string(own_frame(one));
    Mueller values = sample.normalized;
    values(0, 0) = sample.f11;
    for (const Mueller* numbers : std::array<const Mueller*, 2>{&values, &sample.uncertainty})
      for (std::size_t e = 0; e < 16 && (numbers == &values || with_uncertainties_); ++e)
        if (written_[e]) out_ << ',' << (unknown[e] ? "" : shortest(numbers->elements[e]));
    out_ << '\n';
  }
}

void write_samples(std::ostream& out, std::span<const Sample> samples, const std::string& reduction) {
  require_valid(samples);
  if (std::ranges::any_of(reduction, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    throw std::invalid_argument("the text on the reduction has a line end or another control character");
  const bool with_uncertainties = have_uncertainties(samples);
  const bool with_frames = std::ranges::any_of(samples, [](const Sample& s) { return s.as_measured != nullptr; });
  const Elements measured = samples.empty() ? Elements{}.set() : measured_elements(samples);
  const bool x_rays = std::ranges::any_of(samples, [](const Sample& s) { return s.wavelength < 0.01; });
  if (!reduction.empty()) out << "# reduction: " << reduction << '\n';
  SampleWriter(out, measured, with_uncertainties, with_frames, x_rays).write(samples);
}

}  // namespace mmbrdf
