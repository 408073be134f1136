// SPDX-License-Identifier: BSD-3-Clause
#include "formats/netcdf.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/byte_file.hpp"
#include "formats/netcdf_variables.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

bool is_netcdf(std::string_view head, std::uint64_t) {
  const bool classic = head.size() > 3 && head.starts_with("CDF") && (head[3] == 1 || head[3] == 2 || head[3] == 5);
  return classic || head.starts_with("\x89HDF\r\n\x1a\n");
}

#ifndef MMBRDF_NETCDF

std::unique_ptr<ForeignFile::Reader> open_netcdf(const Source& source) {
  throw source.error("a NetCDF file, but this build of mmbrdf has no NetCDF; build it with libnetcdf-dev");
}

#else

namespace {

constexpr std::size_t block_rows = 65536;        // read at once
constexpr std::uint64_t most_compressed = 1100;  // bytes out of one that deflate can make

struct Coordinate {
  const char* name;
  std::vector<std::string> units;  // those that it may have
  std::optional<NetcdfVariable> variable = {};
  double constant = 0;
  std::vector<std::size_t> axes = {};  // of brdf, in the order of the coordinate
};

/// A part of the array: along one axis some, along those behind it all.
struct Block {
  std::vector<std::size_t> start, count;
  std::size_t rows() const {
    std::size_t product = 1;
    for (const std::size_t n : count) product *= n;
    return product;
  }
};

class NetcdfReader : public ForeignFile::Reader {
 public:
  explicit NetcdfReader(const Source& source) : path_(source.path), file_(source.path) {
    const std::optional<NetcdfVariable> brdf = file_.variable("brdf");
    if (!brdf) throw source.error("no variable brdf: not the NetCDF that mmbrdf reads (docs/formats.md)");
    brdf_ = *brdf;
    find_axes(source);
    if (const std::string units = file_.text(brdf_, "units"); units != "sr-1" && units != "sr^-1" && units != "1/sr")
      throw file_.error("brdf", "units " + in_quotes(units) + " are none of sr-1, sr^-1, 1/sr");
    if (matrix_) find_frame();
    find_coordinates(source);
    find_uncertainty();
    measured.reset().set(0);
    if (matrix_) measured.set();
    frames = frame_ != Frame::xy;
    understood = (matrix_ ? "sixteen elements" : std::string("f11")) + " in sr^-1 over (" + axes_text() + ")";
    if (wavelength_told_) understood += " at " + nanometre_text({&coordinates_[0].constant, 1}) + " as told";
    if (!coordinates_[2].variable) understood += ", phi_i = 0";
    if (matrix_)
      understood +=
          ", frame " + to_string(frame_) + ", convention " + to_string(convention_) +
          (frame_ == Frame::xy && convention_ == StokesConvention::germer2017 ? "" : ", made into xy, germer2017") +
          (frame_ == Frame::xy ? "" : " (but for matrices that would lose elements)");
    if (u_ && matrix_) understood += "; u of f_ij made into that of f_ij / f11 as if they were uncorrelated";
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    Block block{std::vector<std::size_t>(lengths_.size()), lengths_};
    std::size_t inner = 1, axis = lengths_.size();
    while (axis > 0 && inner * lengths_[axis - 1] <= block_rows) inner *= lengths_[--axis];
    for (std::size_t a = 0; a < axis; ++a) block.count[a] = 1;
    const std::size_t step = axis == 0 ? 1 : std::max<std::size_t>(1, block_rows / inner);
    do {
      if (axis > 0) block.count[axis - 1] = std::min(step, lengths_[axis - 1] - block.start[axis - 1]);
      read_block(block, sink);
    } while (advance(block, axis));
    sink.finish(path_);
    passed_over = sink.passed_over(matrix_ ? "matrices" : "values");
  }

 private:
  /// To the next block; the last of the outer axes goes in steps. False behind the end.
  bool advance(Block& block, std::size_t axis) const {
    for (std::size_t a = axis; a-- > 0;) {
      block.start[a] += block.count[a];
      if (block.start[a] < lengths_[a]) return true;
      block.start[a] = 0;
    }
    return false;
  }

  void find_axes(const Source& source) {
    axes_ = brdf_.dimensions;
    const std::size_t n = axes_.size();
    matrix_ = n >= 2 && file_.dimension_name(axes_[n - 2]) == "row" && file_.dimension_name(axes_[n - 1]) == "column";
    for (const int axis : axes_) {
      const std::string name = file_.dimension_name(axis);
      lengths_.push_back(file_.length(axis));
      if (!matrix_ && (name == "row" || name == "column"))
        throw file_.error("brdf", "the last two axes must be row, column, but are " + axes_text());
      if (lengths_.back() == 0) throw file_.error("brdf", "axis " + shown_name(name) + " is empty");
    }
    if (matrix_ && (lengths_[n - 2] != 4 || lengths_[n - 1] != 4))
      throw file_.error("brdf", "row and column must be of length 4");
    std::uint64_t bytes = 1;
    for (const std::size_t length : lengths_) bytes = product(bytes, length);
    if (bytes > product(source.size, most_compressed))
      throw file_.error("brdf", std::to_string(bytes) + " numbers are more than a file of " +
                                    std::to_string(source.size) + " bytes can hold");
    if (matrix_) axes_.resize(n - 2), lengths_.resize(n - 2);
  }

  std::string axes_text() const {
    std::string text;
    for (const int axis : axes_) text += (text.empty() ? "" : ", ") + shown_name(file_.dimension_name(axis));
    return text;
  }

  void find_frame() {
    const std::string frame = file_.text(brdf_, "frame"), convention = file_.text(brdf_, "convention");
    if (frame.empty() || convention.empty())
      throw file_.error("brdf", "no attribute " + std::string(frame.empty() ? "frame" : "convention") +
                                    ": it takes a frame (xy, sp, scattering_plane) and a convention (germer2017, …)");
    try {
      frame_ = frame_from(frame);
      convention_ = convention_from(convention.substr(0, convention.find(':')));
    } catch (const std::invalid_argument& refusal) {
      throw file_.error("brdf", refusal.what());
    }
  }

  void find_coordinates(const Source& source) {
    const std::vector<std::string> angles{"degree", "degrees", "deg", ""};
    coordinates_ = {{"wavelength_nm", {"nm", ""}},
                    {"theta_i_deg", angles},
                    {"phi_i_deg", angles},
                    {"theta_r_deg", angles},
                    {"phi_r_deg", angles}};
    for (Coordinate& one : coordinates_) {
      one.variable = file_.variable(one.name);
      if (!one.variable) continue;
      one.axes = axes_of(*one.variable);
      if (const std::string units = file_.text(*one.variable, "units");
          std::ranges::find(one.units, units) == one.units.end())
        throw file_.error(one.name, "units " + in_quotes(units) + " contradict the name");
    }
    wavelength_told_ = !coordinates_[0].variable;
    if (wavelength_told_)
      coordinates_[0].constant = source.told_wavelengths(1, "values").front();
    else
      source.require_none_told();
    for (const std::size_t needed : {1U, 3U, 4U})
      if (!coordinates_[needed].variable) throw source.error(std::string("no variable ") + coordinates_[needed].name);
  }

  /// Which axes of brdf these are.
  std::vector<std::size_t> axes_of(const NetcdfVariable& variable) const {
    std::vector<std::size_t> result;
    for (const int dimension : variable.dimensions) {
      const auto found = std::ranges::find(axes_, dimension);
      if (found == axes_.end())
        throw file_.error(variable.name, "axis " + shown_name(file_.dimension_name(dimension)) + " is none of brdf");
      result.push_back(static_cast<std::size_t>(found - axes_.begin()));
    }
    return result;
  }

  void find_uncertainty() {
    u_ = file_.variable("uncertainty");
    if (u_ && u_->dimensions != brdf_.dimensions) throw file_.error("uncertainty", "its axes are not those of brdf");
    uncertainties = u_.has_value();
  }

  /// A coordinate at each row of the block.
  std::vector<double> values_of(const Coordinate& one, const Block& block) const {
    std::vector<double> result(block.rows(), one.constant);
    if (!one.variable) return result;
    std::vector<std::size_t> start, count;
    std::size_t size = 1;
    for (const std::size_t axis : one.axes) {
      start.push_back(block.start[axis]);
      count.push_back(block.count[axis]);
      size *= block.count[axis];
    }
    std::vector<double> own(size);
    file_.read(*one.variable, start, count, own);
    for (std::size_t row = 0; row < result.size(); ++row) {
      std::vector<std::size_t> place(block.count.size());
      for (std::size_t a = block.count.size(), rest = row; a-- > 0; rest /= block.count[a])
        place[a] = rest % block.count[a];
      std::size_t at = 0;
      for (std::size_t k = 0; k < one.axes.size(); ++k) at = at * count[k] + place[one.axes[k]];
      result[row] = own[at];
      if (!std::isfinite(result[row])) throw file_.error(one.name, "a value is missing or not finite");
    }
    return result;
  }

  std::vector<double> matrices_of(const NetcdfVariable& variable, const Block& block) const {
    std::vector<std::size_t> start = block.start, count = block.count;
    if (matrix_) start.insert(start.end(), {0, 0}), count.insert(count.end(), {4, 4});
    std::vector<double> result(block.rows() * width());
    file_.read(variable, start, count, result);
    return result;
  }

  std::size_t width() const { return matrix_ ? 16 : 1; }

  void read_block(const Block& block, SampleSink& sink) const {
    std::array<std::vector<double>, 5> at;
    for (std::size_t c = 0; c < 5; ++c) at[c] = values_of(coordinates_[c], block);
    const std::vector<double> f = matrices_of(brdf_, block), u = u_ ? matrices_of(*u_, block) : std::vector<double>();
    for (std::size_t row = 0; row < block.rows(); ++row) {
      Geometry geometry;
      try {
        geometry = {direction_from_degrees(at[1][row], at[2][row]), direction_from_degrees(at[3][row], at[4][row])};
      } catch (const std::invalid_argument& refusal) {
        throw std::runtime_error(path_ + ": " + refusal.what());
      }
      const double wavelength = wavelength_told_ ? at[0][row] : at[0][row] / 1000;
      require_wavelength(wavelength, path_ + ": variable wavelength_nm");
      const std::span<const double> of_u =
          u_ ? std::span(u).subspan(row * width(), width()) : std::span<const double>();
      sink.add(sample_of(wavelength, geometry, std::span(f).subspan(row * width(), width()), of_u));
    }
  }

  Sample sample_of(double wavelength, const Geometry& geometry, std::span<const double> f,
                   std::span<const double> u) const {
    Sample sample = scalar_sample(wavelength, geometry, f[0] == 0 && matrix_ ? NAN : f[0]);
    if (!above_horizon(geometry)) return sample;
    for (std::size_t e = 0; e < f.size(); ++e) {
      if (std::isinf(f[e])) throw file_.error("brdf", "an element is infinite");
      if (e > 0) sample.normalized.elements[e] = f[e] / sample.f11;
      if (u.empty() || std::isnan(f[e]) || std::isnan(u[e])) continue;
      if (!(u[e] >= 0) || std::isinf(u[e])) throw file_.error("uncertainty", shortest(u[e]) + " is none");
      sample.uncertainty.elements[e] =
          e == 0 ? u[0] : std::hypot(u[e], sample.normalized.elements[e] * u[0]) / std::abs(sample.f11);
    }
    if (!matrix_ || std::isnan(sample.f11)) return sample;
    if (convention_ != StokesConvention::germer2017)
      sample.normalized = convert(sample.normalized, convention_, StokesConvention::germer2017);
    return frame_ == Frame::xy ? sample : from_frame(sample, frame_);
  }

  std::string path_;
  NetcdfFile file_;
  NetcdfVariable brdf_;
  std::optional<NetcdfVariable> u_;
  std::vector<int> axes_;  // of brdf without row and column
  std::vector<std::size_t> lengths_;
  bool matrix_ = false, wavelength_told_ = false;
  Frame frame_ = Frame::xy;
  StokesConvention convention_ = StokesConvention::germer2017;
  std::vector<Coordinate> coordinates_;
};

}  // namespace

std::unique_ptr<ForeignFile::Reader> open_netcdf(const Source& source) {
  return std::make_unique<NetcdfReader>(source);
}

#endif

}  // namespace mmbrdf
