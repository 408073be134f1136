// SPDX-License-Identifier: BSD-3-Clause
#include "files/sample_columns.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "files/table_layout.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

// M11, M12, M21, M22 = ½ Σ (1, a, b, ab) f_ab, a = +1 for incident s, b for scattered s (theory 6.1); f_a is the sum over b.
struct Polarized {
  std::vector<std::string_view> names;
  std::string_view shown, all_of_them;
  std::vector<std::size_t> elements;
  std::vector<std::vector<double>> signs;  ///< of each element, those of the names
  double unit;                             ///< of f in sr⁻¹
};

namespace {

using namespace std::string_view_literals;

const Polarized polarized_tables[] = {
    {{"f_ss", "f_sp", "f_ps", "f_pp"},
     "f_ss ... f_pp",
     "of f_ss, f_sp, f_ps and f_pp all four",
     {0, 1, 4, 5},
     {{1, 1, 1, 1}, {1, 1, -1, -1}, {1, -1, 1, -1}, {1, -1, -1, 1}},
     1},
    {{"f_s", "f_p"}, "f_s and f_p", "f_s and f_p both", {0, 1}, {{1, 1}, {1, -1}}, 1},
    {{"brf_s", "brf_p"}, "brf_s and brf_p", "brf_s and brf_p both", {0, 1}, {{1, 1}, {1, -1}}, 1 / std::numbers::pi}};

constexpr std::array f11_names = {"f11"sv,           "f_r11"sv,       "fr11"sv,        "brdf"sv,
                                  "f_r11_percent"sv, "f11_percent"sv, "brdf_percent"sv};
constexpr std::array brf_names = {"brf"sv, "reflectance_factor"sv, "brf_percent"sv, "reflectance_factor_percent"sv};
constexpr std::array f_cos_names = {"f_cos"sv, "brdf_cos"sv, "f_cos_percent"sv};
constexpr std::array m11_names = {"m11"sv, "f_r11/f_r11"sv};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const std::string& column_name(const CsvReader& reader, int column) {
  return reader.columns()[static_cast<std::size_t>(column)];
}

/// A value whose square and sums of squares are finite, as any measured one is.
double measured(const CsvReader& reader, int column) {
  constexpr double beyond_all = 1e100;
  const double value = reader.number(column);
  if (std::abs(value) > beyond_all)
    throw reader.error(column_name(reader, column) + ": " + printable(reader.field(column), 40) + " is beyond " +
                       shortest(beyond_all));
  return value;
}

/// NaN where there is no column, or the field is empty.
double measured_or_unknown(const CsvReader& reader, int column) {
  return column < 0 || reader.field(column).empty() ? unknown : measured(reader, column);
}

double uncertainty(const CsvReader& reader, int column) {
  const double value = measured(reader, column);
  if (value < 0)
    throw reader.error(column_name(reader, column) + ": " + printable(reader.field(column), 40) +
                       ": an uncertainty must not be negative");
  return value;
}

/// The digits of a name that is like one of an element: M12, f_12, "m12 [-]", S12, mueller12, F12/F11 … Else nothing.
std::string like_an_element(const std::string& column) {
  std::string name;
  for (const char c : column)
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t digits = name.find_first_of("0123456789");
  if (digits == std::string::npos || digits + 2 > name.size()) return "";
  const std::string letters = name.substr(0, digits), rest = name.substr(digits + 2);
  const auto is_one_of = [](const std::string& word, std::initializer_list<const char*> words) {
    return std::ranges::find(words, word) != words.end();
  };
  const std::string element = name.substr(digits, 2);
  const bool is_there = element.find_first_not_of("1234") == std::string::npos;  // else with few endings only
  return is_one_of(letters, {"m", "f", "s", "fr", "mm", "mueller"}) &&
                 (is_one_of(rest, {"", "1", "f11", "fr11", "m11", "s11", "percent"}) ||
                  (is_there && !std::isdigit(static_cast<unsigned char>(rest.front()))))
             ? element
             : "";
}

/// The column of element 11 in a table that has others, too, under such names; or -1.
int undivided_11(const CsvReader& reader) {
  int found = -1, others = 0;
  for (std::size_t c = 0; c < reader.keys().size(); ++c) {
    const std::string digits = like_an_element(reader.keys()[c]);
    if (digits == "11") found = static_cast<int>(c);
    others += !digits.empty() && digits != "11";
  }
  return others > 0 ? found : -1;
}

/// Refuses such a column of an element which else is not measured, or of none.
void require_no_likeness(const CsvReader& reader, const std::array<int, 16>& columns) {
  for (std::size_t c = 0; c < reader.columns().size(); ++c) {
    const std::string digits = like_an_element(reader.keys()[c]);
    if (digits.empty() || std::ranges::find(columns, static_cast<int>(c)) != columns.end()) continue;
    std::size_t e = 0;
    while (e < 16 && digits != element_name(e)) ++e;
    if (e == 0 || (e < 16 && columns[e] >= 0)) continue;
    const std::string shown = shown_name(reader.columns()[c]);
    throw reader.error("column " + shown + ": " +
                       (e < 16
                            ? "is it " + sample_element(e) + ", the element divided by f11? Then call it so (columns " +
                                  sample_element(e) + "=" + shown + "). "
                            : "elements are called m12 ... m44. ") +
                       "Columns of other names are not read");
  }
}

double scale(const CsvReader& reader, int column) {
  return column >= 0 && reader.keys()[static_cast<std::size_t>(column)].ends_with("_percent") ? 0.01 : 1;
}

/// Whether f11 or an element is made of this column by a factor, so that its uncertainty has to be in the same unit.
bool is_made(const CsvReader& reader, int column) {
  const std::string& key = reader.keys()[static_cast<std::size_t>(column)];
  return key.ends_with("_percent") || std::ranges::find(brf_names, key) != brf_names.end() ||
         std::ranges::find(f_cos_names, key) != f_cos_names.end();
}

/// Refuses an uncertainty of which nothing is read: of f11 under another of its names, or in another unit.
void require_uncertainties_read(const CsvReader& reader, const std::vector<int>& read, int f11) {
  for (std::size_t c = 0; c < reader.keys().size(); ++c) {
    const std::string& key = reader.keys()[c];
    if (!key.starts_with("u_") || std::ranges::find(read, static_cast<int>(c)) != read.end()) continue;
    const std::string of = key.substr(2), without_unit = of.substr(0, of.rfind("_percent"));
    const auto is_among = [&](const auto& names) { return std::ranges::find(names, of) != names.end(); };
    const auto is_of = [&](const Polarized& table) {
      return std::ranges::find(table.names, without_unit) != table.names.end();
    };
    if (is_among(f11_names) || is_among(brf_names) || is_among(f_cos_names) || !like_an_element(of).empty() ||
        std::ranges::any_of(polarized_tables, is_of))
      throw reader.error("column " + shown_name(reader.columns()[c]) + " is of no column that is read" +
                         (f11 < 0 ? ""
                                  : "; that of " + shown_name(column_name(reader, f11)) + " is called u_" +
                                        reader.keys()[static_cast<std::size_t>(f11)] + ", in the same unit"));
  }
}

/// The columns of standard uncertainties, of all that are measured or of none.
template <class Columns, class Name>
Columns uncertainty_columns(const CsvReader& reader, const Columns& values, Name name) {
  Columns columns = values;
  int some = -1;  // of which the uncertainty is there
  for (std::size_t e = 0; e < values.size(); ++e) {
    const std::string own = "u_" + name(e),
                      as_its_column = values[e] < 0 ? own : "u_" + reader.keys()[static_cast<std::size_t>(values[e])];
    const bool same_unit = values[e] < 0 || !is_made(reader, values[e]);
    const std::string_view names[] = {as_its_column, same_unit ? std::string_view(own) : as_its_column};
    columns[e] = reader.find(names);
    if (columns[e] >= 0 && values[e] < 0) throw reader.error("column " + own + ", but no " + name(e));
    if (columns[e] >= 0 && some < 0) some = static_cast<int>(e);
  }
  for (std::size_t e = 0; e < values.size(); ++e)
    if (some >= 0 && values[e] >= 0 && columns[e] < 0)
      throw reader.error("column u_" + name(static_cast<std::size_t>(some)) + ", but no u_" + name(e) +
                         ": uncertainties are needed of all elements that are there, or of none");
  return columns;
}

}  // namespace

ElementColumns::ElementColumns(const CsvReader& reader) {
  const auto find = [&](std::span<const std::string_view> names) { return reader.find(names); };
  const int f11 = find(f11_names), brf = find(brf_names), f_cos = find(f_cos_names);
  std::string there_are;
  for (const int column : {f11, brf, f_cos})
    if (column >= 0) there_are += (there_are.empty() ? "" : " and ") + shown_name(column_name(reader, column));
  if ((f11 >= 0) + (brf >= 0) + (f_cos >= 0) > 1)
    throw reader.error("columns " + there_are + ": both say what f11 is, one of them is needed");
  f11_ = brf >= 0 ? F11::brf : f_cos >= 0 ? F11::f_cos : F11::f;
  elements_[0] = std::max({f11, brf, f_cos});
  percent_ = scale(reader, elements_[0]) != 1;
  find_polarized(reader);
  m11_ = find(m11_names);
  for (std::size_t e = 1; e < 16; ++e) {
    const std::string own = sample_element(e), percent = own + "_percent";
    const std::string published = std::string("f_r").append(own, 1).append("/f_r11");
    const std::string_view names[] = {own, published, percent};
    elements_[e] = find(names);
  }
  if (polarized()) {
    for (const std::size_t e : made_of_->elements)
      if (elements_[e] >= 0)
        throw reader.error("columns " + polarized_names() + ", and " + shown_name(column_name(reader, elements_[e])) +
                           ", which is made of them: one of the two is needed");
  } else if (const int undivided = m11_ >= 0 ? m11_ : undivided_11(reader); elements_[0] < 0 && undivided >= 0) {
    throw reader.error("column " + shown_name(column_name(reader, undivided)) +
                       ", but no f11: samples need the unpolarized BRDF f11 in 1/sr, and m12 ... m44 divided "
                       "by it; a table of elements that are not divided cannot be read as samples");
  } else if (elements_[0] < 0) {
    throw reader.error(
        "no column f11 (nor brdf, brf = pi f, f_cos; nor f_ss, f_sp, f_ps and f_pp, nor f_s and f_p), the unpolarized "
        "BRDF in 1/sr" +
        other_name_hint("f11", reader.columns()));
  }
  std::array<int, 16> there = elements_;
  for (std::size_t k = 0; polarized() && k < made_of_->elements.size(); ++k)
    there[made_of_->elements[k]] = polarized_[k];
  require_no_likeness(reader, there);
  uncertainties_ = uncertainty_columns(reader, elements_, sample_element);
  if (polarized()) find_polarized_uncertainties(reader);
  require_uncertainties_read(reader, columns(), elements_[0]);
  for (std::size_t e = 0; e < 16; ++e) {
    scales_[e] = scale(reader, elements_[e]);
    uncertainty_scales_[e] = scale(reader, uncertainties_[e]);
  }
}

std::string ElementColumns::polarized_names() const { return std::string(made_of_->shown); }

void ElementColumns::find_polarized(const CsvReader& reader) {
  for (const Polarized& table : polarized_tables) {
    std::vector<int> found;
    for (const std::string_view name : table.names) {
      const std::string percent = std::string(name) + "_percent";
      found.push_back(reader.find(std::array{name, std::string_view(percent)}));
    }
    const long count = std::ranges::count_if(found, [](int column) { return column >= 0; });
    if (count == 0) continue;
    if (count < static_cast<long>(found.size()))
      throw reader.error(std::string(table.all_of_them) + " are needed, there " + (count == 1 ? "is " : "are ") +
                         std::to_string(count));
    if (polarized())
      throw reader.error("columns " + polarized_names() + ", and " + std::string(table.shown) + ": one is needed");
    made_of_ = &table;
    polarized_ = found;
    percent_ = scale(reader, found[0]) != 1;
  }
}

void ElementColumns::find_polarized_uncertainties(const CsvReader& reader) {
  polarized_uncertainties_ =
      uncertainty_columns(reader, polarized_, [this](std::size_t p) { return std::string(made_of_->names[p]); });
  const bool has = polarized_uncertainties_[0] >= 0;
  for (std::size_t e = 0; e < 16; ++e)
    if (elements_[e] >= 0 && (uncertainties_[e] >= 0) != has)
      throw reader.error("uncertainties of " + (has ? polarized_names() : sample_element(e)) + ", but none of " +
                         (has ? sample_element(e) : polarized_names()) +
                         ": they are needed of all elements that are there, or of none");
}

void ElementColumns::read_polarized(const CsvReader& reader, Sample& sample) const {
  std::vector<double> f, u(polarized_.size());
  const auto unit = [&](int column) { return made_of_->unit * scale(reader, column); };
  for (const int column : polarized_) f.push_back(unit(column) * measured(reader, column));
  for (std::size_t p = 0; p < u.size() && polarized_uncertainties_[0] >= 0; ++p)
    u[p] = unit(polarized_uncertainties_[p]) * uncertainty(reader, polarized_uncertainties_[p]);
  sample.f11 = std::accumulate(f.begin(), f.end(), 0.0) / 2;
  if (sample.f11 == 0) throw reader.error(polarized_names() + ": their sum is 0, by which elements are to be divided");
  for (std::size_t k = 0; k < made_of_->elements.size(); ++k) {
    const std::vector<double>& signs = made_of_->signs[k];
    const double m = std::inner_product(f.begin(), f.end(), signs.begin(), 0.0) / 2 / sample.f11;
    double squares = 0;
    for (std::size_t p = 0; p < f.size(); ++p) {
      const double slope = k == 0 ? 0.5 : (signs[p] - m) / 2 / sample.f11;
      squares += slope * slope * u[p] * u[p];
    }
    sample.normalized.elements[made_of_->elements[k]] = m;
    sample.uncertainty.elements[made_of_->elements[k]] = std::sqrt(squares);
  }
}

void ElementColumns::read(const CsvReader& reader, Sample& sample) const {
  double unit = 1;
  if (f11_ == F11::brf) unit = 1 / std::numbers::pi;
  if (f11_ == F11::f_cos) {
    const double cosine = std::cos(sample.geometry.reflected.theta);
    if (!(cosine > 1e-12)) throw reader.error("f_cos: tells nothing of f11 at theta_r = 90 degrees");
    unit = 1 / cosine;
  }
  sample.uncertainty = {};
  sample.f11 = unit * scales_[0] * measured_or_unknown(reader, elements_[0]);
  sample.normalized.elements[0] = 1;
  for (std::size_t e = 1; e < 16; ++e)
    sample.normalized.elements[e] = scales_[e] * measured_or_unknown(reader, elements_[e]);
  if (polarized()) read_polarized(reader, sample);
  const Elements missing = not_measured(sample);
  if (missing.all()) throw reader.error("no element is measured: all of these fields are empty");
  for (std::size_t e = 0; e < 16; ++e)
    if (uncertainties_[e] >= 0 && !missing[e])
      sample.uncertainty.elements[e] =
          uncertainty_scales_[e] * (e == 0 ? unit : 1) * uncertainty(reader, uncertainties_[e]);
  if (m11_ >= 0 && reader.number(m11_) != 1)
    throw reader.error("m11: " + printable(reader.field(m11_), 40) +
                       ": must be 1 next to f11, as elements are divided by it");
}

std::vector<int> ElementColumns::columns() const {
  std::vector<int> result;
  const auto add = [&](const auto& columns) {
    std::ranges::copy_if(columns, std::back_inserter(result), [](int column) { return column >= 0; });
  };
  add(elements_), add(uncertainties_), add(polarized_), add(polarized_uncertainties_), add(std::array{m11_});
  return result;
}

bool ElementColumns::complete(const CsvReader& reader) const {
  const auto is_empty = [&](int column) { return column < 0 || reader.field(column).empty(); };
  const auto is_missing = [&](int column) { return column >= 0 && reader.is_missing(column); };
  for (std::size_t e = 0; e < 16; ++e)
    if (!is_empty(elements_[e]) && (is_missing(elements_[e]) || is_missing(uncertainties_[e]))) return false;
  return !is_missing(m11_) && std::ranges::none_of(polarized_, is_missing) &&
         std::ranges::none_of(polarized_uncertainties_, is_missing);
}

std::string ElementColumns::f11_is() const {
  const std::string percent = percent_ ? " / 100" : "";
  if (polarized())
    return (polarized_.size() == 4 ? "f11, m12, m21, m22 of " : "f11, m12 of ") + polarized_names() + percent;
  if (f11_ == F11::brf) return "f11 = brf / pi" + percent;
  if (f11_ == F11::f_cos) return "f11 = f_cos / cos theta_r" + percent;
  return percent_ ? "f11 = f11_percent / 100" : "";
}

}  // namespace mmbrdf
