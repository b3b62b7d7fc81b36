#include "gap/evidence.h"
#include "plant/effects/catalogue.h"

namespace fidservo::gap {

namespace {

/// An effect on the image that moves what is seen changes the tags; one that does more than that, their
/// looks.
std::vector<Signal> reach_of_image_effect(const plant::Effect& effect) {
    plant::PlantParameters parameters;
    parameters.camera.emplace();
    effect.apply(parameters, plant::typical_setting(effect).values);
    if (parameters.camera->readout_s != 0.0) return {Signal::tag};
    if (parameters.camera->extra_exposure_s != 0.0) return {Signal::tag, Signal::image};
    return {Signal::image};
}

}  // namespace

std::vector<Signal> reach_of(const plant::Effect& effect) {
    if (effect.block.starts_with("macro.")) return {Signal::encoder, Signal::tag};
    if (effect.block == "micro.hall") return {Signal::hall, Signal::tag};
    if (effect.block.starts_with("micro.")) return {Signal::hall};
    if (effect.block == "camera.image") return reach_of_image_effect(effect);
    if (effect.block.starts_with("camera.")) return {Signal::tag};
    return {};
}

}  // namespace fidservo::gap
