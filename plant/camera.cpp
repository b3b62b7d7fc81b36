#include "plant/camera.h"

namespace fidservo::plant {

double row_delay_s(const CameraGeometry& camera, const CameraDeviation& deviation, double v_px) {
    if (deviation.readout_s == 0.0 || camera.height_px < 2) return 0.0;
    return deviation.readout_s * (v_px / (camera.height_px - 1) - 0.5);
}

}  // namespace fidservo::plant
