// Which gradient is taken where the picture has none, or where the original code takes another.
#pragma once

namespace sgs {

// kDerivative: that of the picture as it is drawn. kOriginal: what the released code of Kerbl et
// al. 2023 takes for it, which differs in two places: alpha passes its gradient on where it is
// capped at 0.99, and where v_x / v_z or v_y / v_z is clamped in the Jacobian, u = limit v_z is
// held fixed beside v_z.
enum class GradientRule { kDerivative, kOriginal };

}  // namespace sgs
