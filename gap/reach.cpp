#include "gap/evidence.h"

namespace fidservo::gap {

namespace {

/// Whether an effect on the image moves what is seen, and does not only blur or shade it.
bool moves_corners(const plant::Effect& effect) {
    plant::PlantParameters parameters;
    parameters.camera.emplace();
    std::vector<double> typical;
    for (const plant::EffectParameter& parameter : effect.parameters) typical.push_back(parameter.typical);
    effect.apply(parameters, typical);
    return parameters.camera->readout_s != 0.0 || parameters.camera->extra_exposure_s != 0.0;
}

}  // namespace

std::vector<Signal> reach_of(const plant::Effect& effect) {
    if (effect.block.starts_with("macro.")) return {Signal::encoder, Signal::tag};
    if (effect.block == "micro.hall") return {Signal::hall, Signal::tag};
    if (effect.block.starts_with("micro.")) return {Signal::hall};
    if (effect.block == "camera.image" && !moves_corners(effect)) return {};
    if (effect.block.starts_with("camera.")) return {Signal::tag};
    return {};
}

}  // namespace fidservo::gap
