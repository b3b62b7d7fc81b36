// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/leased_image.h"

#include <memory>

#include <opencv2/core.hpp>

namespace fidservo::vision::v4l2 {

namespace {

/// Allocates nothing itself: OpenCV asks it when the last image of a lease has gone.
class LeaseEnd final : public cv::MatAllocator {
  public:
    cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, size_t* step,
                           cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
        return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
    }
    bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
        return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
    }
    void deallocate(cv::UMatData* data) const override {
        const std::unique_ptr<cv::UMatData> owned(data);
        const std::unique_ptr<Lease> lease(static_cast<Lease*>(data->userdata));
        data->userdata = nullptr;
    }
};

const cv::MatAllocator& lease_end() {
    static const LeaseEnd end;
    return end;
}

}  // namespace

cv::Mat leased_image(Lease lease, const cv::Mat& view) {
    auto kept = std::make_unique<Lease>(std::move(lease));
    auto data = std::make_unique<cv::UMatData>(&lease_end());
    data->data = data->origdata = view.data;
    data->size = view.step[0] * static_cast<std::size_t>(view.rows);
    data->flags |= cv::UMatData::USER_ALLOCATED;
    data->refcount = 1;
    data->userdata = kept.release();
    cv::Mat image = view;
    image.u = data.release();
    return image;
}

}  // namespace fidservo::vision::v4l2
