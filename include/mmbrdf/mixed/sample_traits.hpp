// SPDX-License-Identifier: BSD-3-Clause
/// What a sample is like, as its posterior says: its anisotropy, how far source and receiver are not interchangeable, and
/// the noise of its readings.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mmbrdf/mixed/posterior.hpp"

namespace mmbrdf {

/// Of a block at a wavelength. Root mean squares are over its elements and over directions uniform in projected cosine
/// up to 70 degrees, f11 in sr⁻¹ after division by the reflectance.
struct SampleTraits {
  std::string block;
  double noise = 0;                  ///< s: at normal directions, of f11 relative
  std::array<double, 3> anisotropy;  ///< of the harmonics of one, two and three in a turn: √ of their variance
  double nonreciprocal = 0;          ///< of the posterior mean that reciprocity forbids; f11 alone, else 0
};

/// At one of the wavelengths of a posterior, block by block.
std::vector<SampleTraits> sample_traits(const Posterior& posterior, std::size_t wavelength);

/// The same in sentences, a line each: for all wavelengths; what is declared; and, where the source always stood at one
/// azimuth, what turning the sample would have been worth.
std::vector<std::string> described_sample(const Posterior& posterior);

}  // namespace mmbrdf
