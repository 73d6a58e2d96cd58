#pragma once
// Which diodes light which point: V_nm of the paper's eq. 5 to 7.

namespace pmdsim {

// A diode reaches a sample where it stands in front of the surface that the lens sees there and no shape of
// the scene, whichever side it shows, lies between them. The sample's own shape never stands in its way.
// `off`: whatever lies between.
enum class Shadows { off, automatic };

} // namespace pmdsim
