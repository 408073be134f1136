// SPDX-License-Identifier: BSD-3-Clause
// Measurements in the formats of other programs. NetCDF is left to its library.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/formats/foreign.hpp"

using namespace mmbrdf;

namespace {

/// A file in memory with these bytes.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& bytes) : number_(::memfd_create("input", 0)) {
    fuzz::require(::write(number_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
                  "a file in memory");
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string bytes = fuzz::text_of(data + 1, size - 1);
  if (foreign_format(bytes, bytes.size()) == "a NetCDF file") return 0;
  const MemoryFile input(bytes);
  ForeignOptions options;
  options.wavelengths.assign(data[0] % 4U, 0.5);
  std::vector<Sample> samples;
  std::stringstream written;
  const auto read = fuzz::unless_refused([&] {
    ForeignFile file(input.path(), options);
    SampleWriter writer(written, file.measured(), file.has_uncertainties());
    file.read([&](std::span<const Sample> some) {
      writer.write(some);
      samples.insert(samples.end(), some.begin(), some.end());
    });
    return file.understood();
  });
  if (!read) return 0;
  require_valid(samples);
  fuzz::require(!samples.empty() && read->find('\n') == std::string::npos, "a note of one line, and samples");
  fuzz::require(read_samples(written, "written").size() == samples.size(), "what is written has as many samples");
  return 0;
}
