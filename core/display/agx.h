// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// The AgX tone mapper, for linear Rec.709 of any size, in place: display-linear Rec.709, to be encoded.
/// After Sobotka 2022, "AgX S2O3", with the primaries in which Blender 4 and viewers for the web have it.
void agx(float* rgb);

}  // namespace vernier
