// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/formats/foreign.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include "formats/alta.hpp"
#include "formats/astm.hpp"
#include "formats/bird.hpp"
#include "formats/merl.hpp"
#include "formats/netcdf.hpp"
#include "formats/pbsdf.hpp"
#include "formats/reader.hpp"
#include "formats/rgl.hpp"
#include "formats/tensor_file.hpp"
#include "formats/text_file.hpp"
#include "formats/zemax.hpp"
#include "mmbrdf/text/input.hpp"

namespace mmbrdf {
namespace {

/// The first one that a file can be: formats within the same container come before the container.
constexpr std::array formats{
    ForeignFormat{"an ASTM E1392 or E2387 file", is_astm, open_astm},
    ForeignFormat{"a Zemax tabular BSDF file", is_zemax, open_zemax},
    ForeignFormat{"an ALTA text file", is_alta, open_alta},
    ForeignFormat{"a MERL binary file", is_merl, open_merl},
    ForeignFormat{"a BiRD JSON file", is_bird, open_bird},
    ForeignFormat{"a NetCDF file", is_netcdf, open_netcdf},
    ForeignFormat{"a Mitsuba .pbsdf file", is_pbsdf, open_pbsdf},
    ForeignFormat{"an RGL .bsdf file", is_rgl, open_rgl},
    ForeignFormat{"a tensor file", is_tensor_file, open_other_tensor},
};

const ForeignFormat* format_of(std::string_view head, std::uint64_t size) {
  if (head.starts_with(byte_order_mark)) head.remove_prefix(byte_order_mark.size());  // of any text
  const auto* found = std::ranges::find_if(formats, [&](const ForeignFormat& format) { return format.is(head, size); });
  return found == formats.end() ? nullptr : found;
}

struct Beginning {
  std::string head;
  std::uint64_t size = 0;
};

Beginning beginning_of(const std::string& path) {
  std::ifstream in = open_input(path);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  Beginning result{std::string(foreign_head, '\0'), std::filesystem::file_size(path)};
  in.read(result.head.data(), static_cast<std::streamsize>(foreign_head));
  result.head.resize(static_cast<std::size_t>(in.gcount()));
  return result;
}

}  // namespace

std::string foreign_format(std::string_view head, std::uint64_t size) {
  const ForeignFormat* format = format_of(head.substr(0, foreign_head), size);
  return format == nullptr ? "" : format->name;
}

std::string foreign_format(const std::string& path) {
  const Beginning beginning = beginning_of(path);
  return foreign_format(beginning.head, beginning.size);
}

ForeignFile::ForeignFile(const std::string& path, const ForeignOptions& options) : path_(path) {
  const Beginning beginning = beginning_of(path);
  const ForeignFormat* format = format_of(beginning.head, beginning.size);
  if (format == nullptr) throw std::runtime_error(path + ": in no format of measurements that is known");
  format_ = format->name;
  reader_ = format->open({path, beginning.head, beginning.size, options});
}

ForeignFile::~ForeignFile() = default;
ForeignFile::ForeignFile(ForeignFile&&) noexcept = default;
ForeignFile& ForeignFile::operator=(ForeignFile&&) noexcept = default;

Elements ForeignFile::measured() const { return reader_->measured; }
bool ForeignFile::has_uncertainties() const { return reader_->uncertainties; }
bool ForeignFile::has_frames() const { return reader_->frames; }
void ForeignFile::read(const std::function<void(std::span<const Sample>)>& use) { reader_->read(use); }

std::string ForeignFile::understood() const { return format_ + ": " + reader_->understood + reader_->passed_over; }

}  // namespace mmbrdf
