#include <haptics/realtime/run_columns.hpp>

namespace haptics {

const std::vector<std::string>& run_column_names() {
    static const std::vector<std::string> names{"t_s",
                                                "device_x_m",
                                                "device_y_m",
                                                "device_theta_rad",
                                                "proxy_x_m",
                                                "proxy_y_m",
                                                "proxy_theta_rad",
                                                "device_vx_m_s",
                                                "device_vy_m_s",
                                                "device_omega_rad_s",
                                                "proxy_vx_m_s",
                                                "proxy_vy_m_s",
                                                "proxy_omega_rad_s",
                                                "force_x_n",
                                                "force_y_n",
                                                "torque_n_m",
                                                "command_x_n",
                                                "command_y_n",
                                                "command_torque_n_m",
                                                "contact_force_x_n",
                                                "contact_force_y_n",
                                                "contact_torque_n_m",
                                                "coupling_x_n",
                                                "coupling_y_n",
                                                "coupling_torque_n_m",
                                                "hand_force_x_n",
                                                "hand_force_y_n",
                                                "hand_torque_n_m",
                                                "impulse_x_n",
                                                "impulse_y_n",
                                                "impulse_torque_n_m",
                                                "contacts",
                                                "colliding",
                                                "sticking",
                                                "sliding",
                                                "max_penetration_m",
                                                "energy_injected_j",
                                                "armed",
                                                "gate_flags",
                                                "fault_flags",
                                                "held",
                                                "reading_missing",
                                                "fallbacks",
                                                "exact_gave_way",
                                                "buttons"};
    return names;
}

void fill_run_row(const HapticReport& r, std::array<double, k_run_columns>& row) noexcept {
    std::size_t i = 0;
    const auto put = [&](double value) { row[i++] = value; };
    const auto put3 = [&](const Vec3& v) {
        put(v.x());
        put(v.y());
        put(v.z());
    };
    put(r.time);
    put3(r.device);
    put3(r.grip);
    put3(r.device_velocity);
    put3(r.velocity);
    put3(r.force);
    put3(r.command);
    put3(r.contact);
    put3(r.coupling);
    put3(r.hand);
    put3(r.impulse_force);
    put(r.contacts);
    put(r.colliding);
    put(r.sticking);
    put(r.sliding);
    put(r.max_penetration);
    put(r.energy_injected);
    put(r.armed ? 1.0 : 0.0);
    put(static_cast<double>(r.gate));
    put(static_cast<double>(r.faults));
    put(r.held ? 1.0 : 0.0);
    put(r.reading_missing ? 1.0 : 0.0);
    put(static_cast<double>(r.fallbacks));
    put(static_cast<double>(r.exact_gave_way));
    put(static_cast<double>(r.buttons));
}

} // namespace haptics
