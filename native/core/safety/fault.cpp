#include <haptics/core/safety/fault.hpp>

#include <array>
#include <cstddef>

namespace haptics {

const char* describe_fault(int bit) {
    static constexpr std::array<const char*, k_fault_count> k_text{
        "The controller commanded a force that is not a number. Fix the controller, then re-arm.",
        "The handle's pose or velocity is not a number. Check the encoders, then re-arm.",
        "The handle moved faster than the speed limit. Move slower or soften the coupling, then re-arm.",
        "More energy went into the hand than the limit allows. Soften the coupling or add damping, then "
        "re-arm.",
        "The handle left the workspace. Bring it back into the workspace, then re-arm.",
        "The encoders contradict one another. Home the device again, then re-arm.",
        "The step time was zero, negative or not a number. Restart the loop, then re-arm.",
        "No sample came from the device in time. Reconnect the device, then re-arm.",
        "Stop was pressed. Release the stop, then re-arm.",
        "The controller creates energy. Lower the stiffness, then re-arm.",
        "An encoder jumped or reports an error. Check the encoder's wiring, home the device again, then "
        "re-arm.",
        "No command reached the device in time, so it let its motors go. Close other programs or lower the "
        "rate, "
        "then re-arm.",
        "The device reports a fault of its own (motor driver or heat). Let it recover, then re-arm.",
        "The model of the scene became unstable, and the tool was put back at rest. Make extreme figures "
        "milder (light bodies, stiff surfaces, shapes inside of each other), then re-arm.",
    };
    return bit >= 0 && bit < k_fault_count ? k_text[static_cast<std::size_t>(bit)] : "";
}

} // namespace haptics
