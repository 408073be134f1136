// SPDX-License-Identifier: BSD-3-Clause
/// Families of modes, and what differs between them besides the modes.
#pragma once

#include <string>

namespace mmbrdf {

/// Which modes a basis has.
enum class Family {
  isotropic,    ///< spin-weighted modes, k + l = 2 (σ_out + σ_in): exactly rotation-covariant, mirror-symmetric and
                ///< reciprocal. 142 modes at orders 7, 4. Theory 2.3.
  germer2017,   ///< the index sets of the published coefficient files, 330 modes at orders 7, 4 (Eqs. 8, 14–16). They
                ///< hold at phi_i = 0 only, so models are evaluated there and turned (theory 2.2).
  anisotropic,  ///< every index: the complete reciprocal expansion, Eqs. 1, 2 and 14–16. 2376 modes at orders 7, 4.
};

/// How azimuths enter.
enum class Rotation {
  covariant,   ///< as an isotropic sample demands. germer2017 is evaluated at phi_i = 0 and turned: M(phi_i, phi_r) =
               ///< R(−phi_i) M(0, phi_r − phi_i) R(−phi_i). The other families are evaluated as they are.
  as_printed,  ///< the published sum at the azimuths given. For comparison with other programs only: for germer2017 the
               ///< answer then depends on how the sample is turned, since the files lack the sine partners of their
               ///< modes, and it misses the measured random directions by half as much again (0.0175 against 0.0113).
};

/// What the library does otherwise for one family than for another.
struct FamilyTraits {
  bool at_zero_azimuth;  ///< holds at phi_i = 0 only: is evaluated there and turned, unless as_printed
  bool minimum_norm;     ///< the data never determine every mode: fits take the smallest solution
  bool published_form;   ///< its models can be written, exactly, in the modes of the published files
};
FamilyTraits traits(Family family);

/// Whether samples are turned to phi_i = 0 for a fit, and matrices turned back.
bool turns(Family family, Rotation rotation);

/// Throws std::invalid_argument for as_printed of a family that is evaluated as it is.
void require_valid(Family family, Rotation rotation);

/// The names used in files and by the program: isotropic, germer2017, anisotropic; covariant, as_printed.
std::string to_string(Family family);
std::string to_string(Rotation rotation);
Family family_from(const std::string& name);      ///< throws std::invalid_argument for another name
Rotation rotation_from(const std::string& name);  ///< throws std::invalid_argument for another name

}  // namespace mmbrdf
