// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_refinement.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/median.h"
#include "vision/tags/band_model.h"
#include "vision/tags/band_outliers.h"
#include "vision/tags/edge_band.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_pattern.h"
#include "vision/tags/tag_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

namespace fidservo::vision {
namespace {

constexpr double least_side_px = 24.0;
constexpr double least_contrast = 8.0;  ///< grey levels; below, noise decides where the edges are
constexpr double least_explained = 0.3;
constexpr double enough_explained = 0.95;  ///< as a tag that fits has it
constexpr double clearly_more = 0.02;
constexpr double most_of_rims = 0.15;
constexpr double narrowest_px = 4.0;  ///< reach of a quick look
constexpr double sharpest_px = 0.3;   ///< the area of a pixel alone blurs by 0.29 px

/// Standard deviations of what is known of the look beforehand: so wide that they matter only where the
/// pixels say nothing.
constexpr std::array<double, kernel::look_columns> look_prior{1.0,   1.0,   1.0, 0.05, 0.05, 0.02,
                                                              300.0, 300.0, 0.5, 0.5,  0.5};

/// Less motion than this only widens the blur, which is fitted.
double motion_that_matters(double along_normal_px) {
    constexpr double least_px = 0.5;
    return std::abs(along_normal_px) < least_px ? 0.0 : std::abs(along_normal_px);
}

/// The light from the middles of the cells.
void read_levels(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern, BandLook& look) {
    std::vector<double> dark;
    std::vector<double> bright;
    const int cells = pattern.cells;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const Eigen::Vector2d at =
                picture.image_of({column + 0.5 - 0.5 * cells, row + 0.5 - 0.5 * cells});
            if (can_sample(image, at))
                (pattern[row * cells + column] ? bright : dark).push_back(sample(image, at));
        }
    if (!dark.empty()) look.black_grey = median_of(std::move(dark));
    if (!bright.empty()) look.white_grey = median_of(std::move(bright));
}

/// Kept from tag to tag: fresh memory costs more than its use.
struct WorkingMemory {
    EdgeBand band;
    std::vector<kernel::Residuals> residuals;
    BlockJudgement judgement;
    std::vector<float> weights_before;
};

/// One tag under refinement.
class Fit {
  public:
    Fit(const cv::Mat& image, const TagDetection& found, const RefinementOptions& options,
        WorkingMemory& memory)
        : image_(image),
          options_(options),
          pattern_(tag_pattern(found.print, found.tag_id)),
          picture_(found.corners_px, pattern_.outline_cells(), options.camera, pattern_.rim),
          band_(memory.band),
          residuals_(memory.residuals),
          judgement_(memory.judgement),
          weights_before_(memory.weights_before) {
        const Eigen::Matrix2d cells_by_px = picture_.cells_by_px(picture_.image_of({0.0, 0.0}));
        cell_px_ = 1.0 / std::max(cells_by_px.row(0).norm(), cells_by_px.row(1).norm());
        const Eigen::Vector2d motion_cells = cells_by_px * options.motion_px;
        look_.motion_x_px = motion_that_matters(motion_cells.x() / cells_by_px.row(0).norm());
        look_.motion_y_px = motion_that_matters(motion_cells.y() / cells_by_px.row(1).norm());
        look_.blur_x_px = look_.blur_y_px = possible_blur(options.blur_px);
        read_levels(image_, picture_, pattern_, look_);
    }

    bool has_contrast() const { return look_.white_grey - look_.black_grey >= least_contrast; }

    /// A quick fit that tolerates much: brings the model to within some hundredths of a pixel.
    bool look_roughly() {
        constexpr int most_steps = 16;
        double reach_px = std::min(std::max(narrowest_px, 2.5 * look_.blur_x_px), 0.5 * cell_px_);
        select(reach_px, share_for(reach_px));
        for (int k = 0; k < most_steps; ++k) {
            const std::optional<Step> step = take_step(Outliers::lose_weight);
            if (!step || !has_contrast()) return false;
            const double blur_px = std::max(look_.blur_x_px, look_.blur_y_px);
            if (2.3 * blur_px > reach_px && reach_px < 0.5 * cell_px_) {
                reach_px = std::min(2.0 * reach_px, 0.5 * cell_px_);
                select(reach_px, share_for(reach_px));
            } else if (step->is_within(0.06, 0.06) && k > 0) {
                return true;
            }
        }
        return false;
    }

    /// The fit that counts. False if too little of the tag can be seen.
    bool look_closely() {
        constexpr double reach_in_blurs = 2.5;
        infer_motion();
        select(reach_in_blurs * std::max(look_.blur_x_px, look_.blur_y_px) + 0.2, 1.0);
        if (!settle(Outliers::are_left_out)) return false;
        if (explained_ < 1.0) follow_rims();
        return explained_ >= least_explained;
    }

    RefinedTag result(TagDetection tag) const {
        Eigen::MatrixXd normal = last_.normal;
        add_priors(normal);
        Eigen::MatrixXd covariance =
            normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
        const double freedom = static_cast<double>(used_) - static_cast<double>(normal.rows());
        const double misfit = square_sum_ / freedom;
        const bool fits = misfit < 1.0 + 2.33 * std::sqrt(2.0 / freedom);
        if (!fits)
            covariance = covariance * band_scatter(band_, picture_, look_, options_.noise) * covariance;

        const int geometry = picture_.parameters();
        const Eigen::MatrixXd of_geometry = covariance.topLeftCorner(geometry, geometry);
        Eigen::MatrixXd corners(8, geometry);
        for (int k = 0; k < 4; ++k) {
            const Eigen::Vector2d corner = 0.5 * pattern_.outline_cells() * tag_corners[k];
            tag.corners_px[k] = picture_.image_of(corner);
            corners.middleRows<2>(2 * k) = picture_.image_by_parameters(corner);
        }
        const Eigen::MatrixXd centre = picture_.image_by_parameters({0.0, 0.0});
        return {tag,
                corners * of_geometry * corners.transpose(),
                picture_.image_of({0.0, 0.0}),
                centre * of_geometry * centre.transpose(),
                explained_,
                0.5 * (look_.blur_x_px + look_.blur_y_px),
                look_.spread_px,
                misfit,
                fits,
                options_.camera.has_value()};
    }

  private:
    /// What becomes of blocks that do not fit: little by little as long as the model is not in its place.
    enum class Outliers { lose_weight, are_left_out, and_rims_are_left_out };

    /// Steps until the next would change nothing. False if the pixels do not determine it.
    bool settle(Outliers outliers) {
        constexpr int most_steps = 8;
        constexpr double nearly_all = 0.98;  ///< less left out does not change which blocks fit
        for (int k = 0; k < most_steps; ++k) {
            const std::optional<Step> step = take_step(outliers);
            if (!step || !has_contrast()) return false;
            if (step->is_within(0.02, 0.04) && (k > 0 || explained_ > nearly_all)) break;
        }
        return true;
    }

    /// Leaves out what damage reaches beyond what misfits by itself. Not where that is much of the tag: it is
    /// no damage then, but a lens or print that is not as believed.
    void follow_rims() {
        const auto before = std::tuple(picture_, look_, last_, square_sum_, explained_, used_, band_.weights);
        const double explained = explained_;
        const bool settled = settle(Outliers::and_rims_are_left_out);
        if (settled && explained_ > explained - most_of_rims) return;
        std::tie(picture_, look_, last_, square_sum_, explained_, used_, band_.weights) = before;
    }

    /// Of the edges that a quick look takes. The wider the reach, the fewer the edges, down to crossings
    /// alone: a handful of these would not tell all of the tag's geometry.
    double share_for(double reach_px) const {
        constexpr double enough_pixels = 1500.0, cell_sides = 70.0;  // of which a code has about so many
        constexpr double least_of_wide = 0.3;
        const double share = enough_pixels / (cell_sides * cell_px_ * 2.0 * reach_px);
        return std::min(1.0, reach_px > narrowest_px ? std::max(least_of_wide, share) : share);
    }

    double possible_blur(double blur_px) const {
        return std::clamp(blur_px, sharpest_px, std::max(0.5 * cell_px_, sharpest_px));
    }

    /// Motion that nobody told of shows in unequal blurs: a stretch m has the variance m^2 / 12.
    void infer_motion() {
        constexpr double unequal = 1.25;
        const auto infer = [](double& blur_px, double other_px, double& motion_px) {
            if (motion_px > 0.0 || blur_px < unequal * other_px) return;
            motion_px = std::sqrt(12.0 * (blur_px * blur_px - other_px * other_px));
            blur_px = other_px;
        };
        infer(look_.blur_x_px, look_.blur_y_px, look_.motion_x_px);
        infer(look_.blur_y_px, look_.blur_x_px, look_.motion_y_px);
    }

    void select(double reach_px, double share) {
        select_band(image_, picture_, pattern_,
                    {reach_px + 0.5 * look_.motion_x_px, reach_px + 0.5 * look_.motion_y_px}, share, band_);
    }

    static void add_priors(Eigen::MatrixXd& normal) {
        for (int k = 0; k < kernel::look_columns; ++k) {
            const auto at = normal.rows() - kernel::look_columns + k;
            normal(at, at) += 1.0 / (look_prior[k] * look_prior[k]);
        }
    }

    /// Shape and light are believed to be nought; blurs and levels are only kept from running away.
    void pull(Eigen::VectorXd& right) const {
        const auto by_prior = [](int k, double value) { return value / (look_prior[k] * look_prior[k]); };
        auto look = right.tail<kernel::look_columns>();
        look(kernel::spread) -= by_prior(kernel::spread, look_.spread_px);
        look(kernel::skew) -= by_prior(kernel::skew, look_.skew_factor);
        look(kernel::tail) -= by_prior(kernel::tail, look_.tail_factor);
        look(kernel::kink) -= by_prior(kernel::kink, look_.kink_factor);
        for (int k = 0; k < 3; ++k)
            look(kernel::light_x + k) -= by_prior(kernel::light_x + k, look_.light(k));
    }

    struct Step {
        double moved_px;
        double widened;  ///< largest change of a blur, as a part of it

        /// Gauss-Newton converges quadratically: a step of 0.06 px leaves 0.002 px, one of 0.02 px 0.0002 px.
        bool is_within(double most_px, double most_widened) const {
            return moved_px < most_px && widened < most_widened;
        }
    };

    /// One Gauss-Newton step; empty if the pixels do not determine it.
    std::optional<Step> take_step(Outliers outliers) {
        last_ = evaluate_band(band_, picture_, look_, options_.noise, residuals_);
        weights_before_ = band_.weights;
        weigh_blocks(outliers);
        if (band_.weights != weights_before_)
            reweigh(last_, band_, weights_before_, picture_, look_, options_.noise);
        Eigen::MatrixXd normal = last_.normal;
        add_priors(normal);
        Eigen::VectorXd right = last_.right;
        pull(right);
        const Eigen::VectorXd step = normal.ldlt().solve(right);
        if (!step.allFinite()) return {};
        constexpr double longest_px = 1.5;
        const double moved_px = cell_px_ * step.head<2>().norm();
        const auto look = step.tail<kernel::look_columns>();
        const double widened = std::max(std::abs(look(kernel::width_x)), std::abs(look(kernel::width_y)));
        apply(moved_px > longest_px ? Eigen::VectorXd(step * (longest_px / moved_px)) : step);
        square_sum_ = last_.square_sum - step.dot(right);
        return Step{moved_px, widened};
    }

    void apply(const Eigen::VectorXd& step) {
        picture_.change(step);
        const auto look = step.tail<kernel::look_columns>();
        const auto widened = [&](double blur_px, double change) {
            return possible_blur(blur_px * std::exp(std::clamp(change, -0.7, 0.7)));
        };
        look_.blur_x_px = widened(look_.blur_x_px, look(kernel::width_x));
        look_.blur_y_px = widened(look_.blur_y_px, look(kernel::width_y));
        look_.spread_px += look(kernel::spread);
        look_.skew_factor += look(kernel::skew);
        look_.tail_factor += look(kernel::tail);
        look_.kink_factor += look(kernel::kink);
        look_.white_grey += look(kernel::white);
        look_.black_grey += look(kernel::black);
        look_.light += look.segment<3>(kernel::light_x);
    }

    /// Sets the blocks' weights by what the model leaves of them.
    void weigh_blocks(Outliers outliers) {
        constexpr double rounding_in_common =
            0.09;  // grey levels squared: a 12th, and a little for the model
        const double allowance = 1.0 + rounding_in_common / options_.noise.variance(look_.black_grey);
        judge_blocks(band_, static_cast<float>(allowance), residuals_, judgement_);
        if (outliers == Outliers::and_rims_are_left_out) follow_damage(band_, residuals_, judgement_);
        used_ = 0;
        const std::vector<float>& excess = judgement_.excess;
        for (std::size_t k = 0; k < excess.size(); ++k) {
            const bool fits = excess[k] <= 1.0F;
            if (fits) used_ += band_.blocks[k].pixels;
            band_.weights[k] = fits                                ? 1.0F
                               : outliers == Outliers::lose_weight ? 0.5F / std::sqrt(excess[k])
                                                                   : 0.0F;
        }
        explained_ = static_cast<double>(used_) / static_cast<double>(std::max<std::size_t>(1, band_.pixels));
    }

    const cv::Mat& image_;
    const RefinementOptions& options_;
    TagPattern pattern_;
    TagPicture picture_;
    BandLook look_;
    double cell_px_;
    EdgeBand& band_;
    std::vector<kernel::Residuals>& residuals_;
    BlockJudgement& judgement_;
    std::vector<float>& weights_before_;
    BandEquations last_;
    double square_sum_ = 0.0;
    double explained_ = 1.0;
    std::size_t used_ = 0;
};

/// Covariance of the mean of four points.
Eigen::Matrix2d mean_covariance_px2(const CornerCovariance& corners) {
    Eigen::Matrix<double, 2, 8> mean;
    for (int k = 0; k < 4; ++k) mean.block<2, 2>(0, 2 * k) = 0.25 * Eigen::Matrix2d::Identity();
    return mean * corners * mean.transpose();
}

Failure hidden(const char* why) {
    return {Reason::occluded, why};
}

CornerCovariances of_single_corners(const CornerCovariance& all_px2) {
    CornerCovariances of_corners;
    for (int k = 0; k < 4; ++k) of_corners[static_cast<std::size_t>(k)] = all_px2.block<2, 2>(2 * k, 2 * k);
    return of_corners;
}

Result<RefinedTag> fit_picture(const cv::Mat& image, const TagDetection& found,
                               const RefinementOptions& options, double shortest_px) {
    thread_local WorkingMemory memory;
    Fit fit(image, found, options, memory);
    if (!fit.has_contrast()) return tl::make_unexpected(hidden("the tag's code is not there"));
    if (!fit.look_roughly() || !fit.look_closely())
        return tl::make_unexpected(hidden("too little of the tag is to be seen"));
    RefinedTag refined = fit.result(found);
    refined.detection.is_refined = true;
    refined.detection.covariances_px2 = of_single_corners(refined.covariance_px2);
    const double cell_px = shortest_px / found.print.outline_cells();
    for (std::size_t k = 0; k < 4; ++k)
        if (!((refined.detection.corners_px[k] - found.corners_px[k]).norm() <= std::max(2.0, cell_px)))
            return tl::make_unexpected(hidden("the tag's border does not end where its code says"));
    return refined;
}

}  // namespace

Result<RefinedTag> refine_tag(const cv::Mat& image, const TagDetection& found,
                              const RefinementOptions& options) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    double shortest_px = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d& corner = found.corners_px[k];
        shortest_px = std::min(shortest_px, (found.corners_px[(k + 1) % 4] - corner).norm());
        if (!(corner.x() > -0.5 && corner.y() > -0.5 && corner.x() < image.cols - 0.5 &&
              corner.y() < image.rows - 0.5))
            return tl::make_unexpected(hidden("the tag leaves the image"));
    }
    if (!(shortest_px >= least_side_px))
        return tl::make_unexpected(hidden("the tag is too small for its edges to be measured"));

    const Result<RefinedTag> refined = fit_picture(image, found, options, shortest_px);
    if (!options.camera || (refined && refined->explained >= enough_explained)) return refined;
    // The camera may not be as its calibration says: then a free perspective shows more of the tag.
    RefinementOptions free = options;
    free.camera.reset();
    const Result<RefinedTag> freely = fit_picture(image, found, free, shortest_px);
    const bool shows_more = freely && (!refined || freely->explained > refined->explained + clearly_more);
    return shows_more ? freely : refined;
}

RefinedTag tag_of_corners(const TagDetection& corners, const CornerCovariance& covariance_px2) {
    RefinedTag tag{corners, covariance_px2, centre_px(corners), mean_covariance_px2(covariance_px2)};
    tag.detection.is_refined = false;
    tag.detection.covariances_px2 = of_single_corners(covariance_px2);
    return tag;
}

RefinedTag unrefined(const TagDetection& found) {
    constexpr double library_std_px = 0.2;
    RefinedTag tag = tag_of_corners(found, CornerCovariance::Identity() * (library_std_px * library_std_px));
    tag.explained = 0.0;
    return tag;
}

Eigen::Vector2d centre_px(const TagDetection& tag) {
    return centre_of(tag.corners_px);
}

}  // namespace fidservo::vision
