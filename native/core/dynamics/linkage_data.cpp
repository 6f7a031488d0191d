#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

void reset(const LinkageModel& model, LinkageData& data) {
    data.position.setZero(model.freedoms);
    data.velocity.setZero(model.freedoms);
    for (BodyNumbers* numbers :
         {&data.angle, &data.rate, &data.sine, &data.x, &data.y, &data.velocity_x, &data.velocity_y,
          &data.arm_x, &data.arm_y, &data.axis_x, &data.axis_y, &data.bias_x, &data.bias_y}) {
        *numbers = BodyNumbers{};
    }
    for (double& cosine : data.cosine) {
        cosine = 1.0;
    }
}

} // namespace haptics
