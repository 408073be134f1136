// SPDX-License-Identifier: BSD-3-Clause
#include "formats/merl.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "formats/byte_file.hpp"
#include "formats/half_difference.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::uint64_t header = 12;
constexpr std::array<double, 3> scales{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::array<std::int32_t, 3> usual{90, 90, 180};

std::array<std::int32_t, 3> counts(std::string_view head) {
  std::array<std::int32_t, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = little_endian<std::int32_t>(head.data() + 4 * i);
  return result;
}

/// Bytes of a file of these counts; 2^64 − 1 if they are no counts.
std::uint64_t size_of(const std::array<std::int32_t, 3>& counts) {
  std::uint64_t result = 24;
  for (const std::int32_t count : counts)
    result = product(result, count > 0 ? static_cast<std::uint64_t>(count) : ~0ULL);
  return result > ~0ULL - header ? ~0ULL : result + header;
}

class MerlReader : public ForeignFile::Reader {
 public:
  explicit MerlReader(const Source& source) : path_(source.path), file_(source.path), counts_(counts(source.head)) {
    if (source.size != size_of(counts_))
      throw source.error("has " + std::to_string(source.size) + " bytes, but " + text() + " nodes take " +
                         std::to_string(size_of(counts_)) + ": cut off?");
    wavelengths_ = source.told_wavelengths(3, "3 colours, red, green and blue");
    understood = text() +
                 " theta_h, theta_d, phi_d, each value taken as that of the middle of its interval, f11 in sr^-1 " +
                 "of red, green and blue at " + nanometre_text(wavelengths_) + " as told; phi_i = 0";
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    const auto nodes = static_cast<std::size_t>(counts_[1]) * static_cast<std::size_t>(counts_[2]);
    const std::uint64_t plane = nodes * static_cast<std::uint64_t>(counts_[0]) * 8;
    std::vector<char> bytes(3 * nodes * 8);
    for (int h = 0; h < counts_[0]; ++h) {
      for (std::size_t colour = 0; colour < 3; ++colour)
        file_.read(header + colour * plane + static_cast<std::uint64_t>(h) * nodes * 8,
                   std::span(bytes).subspan(colour * nodes * 8, nodes * 8));
      for (std::size_t node = 0; node < nodes; ++node) add(h, node, nodes, bytes, sink);
    }
    sink.finish(path_);
    passed_over = sink.passed_over("values");
  }

 private:
  std::string text() const {
    return std::to_string(counts_[0]) + " x " + std::to_string(counts_[1]) + " x " + std::to_string(counts_[2]);
  }

  /// A value stands for the interval from its place to the next one: the places of theta_h are squares.
  HalfDifference directions(int h, std::size_t node) const {
    const auto azimuths = static_cast<std::size_t>(counts_[2]);
    const double root = (h + 0.5) / counts_[0], d = static_cast<double>(node / azimuths) + 0.5,
                 p = static_cast<double>(node % azimuths) + 0.5;
    return half_difference(root * root * std::numbers::pi / 2, d / counts_[1] * std::numbers::pi / 2,
                           p / counts_[2] * std::numbers::pi);
  }

  void add(int h, std::size_t node, std::size_t nodes, const std::vector<char>& bytes, SampleSink& sink) const {
    const HalfDifference both = directions(h, node);
    if (!above_horizon(both)) return sink.below_horizon(3);
    const Geometry geometry = isotropic_geometry(both.incident, both.reflected);
    for (std::size_t colour = 0; colour < 3; ++colour) {
      const double value = little_endian<double>(bytes.data() + (colour * nodes + node) * 8);
      if (!std::isfinite(value))
        throw std::runtime_error(path_ + ": value " + std::to_string(static_cast<std::size_t>(h) * nodes + node + 1) +
                                 " of colour " + std::to_string(colour + 1) + ": " + shortest(value) +
                                 ", must be finite");
      if (value < 0)
        sink.not_measured();  // −1 stands for nothing
      else
        sink.add(scalar_sample(wavelengths_[colour], geometry, value * scales[colour]));
    }
  }

  std::string path_;
  ByteFile file_;
  std::array<std::int32_t, 3> counts_;
  std::vector<double> wavelengths_;
};

}  // namespace

bool is_merl(std::string_view head, std::uint64_t size) {
  return head.size() >= header && (counts(head) == usual || size_of(counts(head)) == size);
}

std::unique_ptr<ForeignFile::Reader> open_merl(const Source& source) { return std::make_unique<MerlReader>(source); }

}  // namespace mmbrdf
