#include <haptics/classes/geometry_reader.hpp>
#include <haptics/classes/world_settings.hpp>
#include <haptics/core/local_model/validate.hpp>

#include <cmath>

namespace haptics {

using namespace godot;

namespace {

SafetyLimits read_safety(const Dictionary& from, Problems& problems) {
    SafetyLimits s;
    DictionaryReader r(from, "safety.", problems);
    s.max_force = r.number("max_force", s.max_force);
    s.max_torque = r.number("max_torque", s.max_torque);
    s.force_slew = r.number("force_slew", s.force_slew);
    s.torque_slew = r.number("torque_slew", s.torque_slew);
    s.reference_mass = r.number("reference_mass", s.reference_mass);
    s.reference_inertia = r.number("reference_inertia", s.reference_inertia);
    s.max_speed = r.number("max_speed", s.max_speed);
    s.max_angular_speed = r.number("max_angular_speed", s.max_angular_speed);
    s.max_energy = r.number("max_energy", s.max_energy);
    s.ramp_time = r.number("ramp_time", s.ramp_time);
    s.pause_fade_time = r.number("pause_fade_time", s.pause_fade_time);
    r.finish();
    problems.add(validate(s));
    return s;
}

CompensationSettings read_compensation(const Dictionary& from, Problems& problems) {
    CompensationSettings c;
    DictionaryReader r(from, "compensation.", problems);
    c.gravity = r.vec2("gravity", c.gravity);
    c.friction_share = r.number("friction_share", c.friction_share);
    c.inertia_share = r.number("inertia_share", c.inertia_share);
    c.velocity_window = r.number("velocity_window", c.velocity_window);
    c.coulomb_rate = r.number("coulomb_rate", c.coulomb_rate);
    c.acceleration_bandwidth = r.number("acceleration_bandwidth", c.acceleration_bandwidth);
    c.energy_reserve = r.number("energy_reserve", c.energy_reserve);
    r.finish();
    return c;
}

// what every kind of pantograph has: its linkage, and what the loop does for it
PantographGeometry read_linkage(DictionaryReader& r, DeviceCareSettings& care, Problems& problems) {
    Problems own;
    DeviceGeometry geometry = read_geometry(r, own);
    // of a geometry that was found wanting nothing more is said
    if (!own.none())
        geometry.figures = ubc_twin_pantograph();
    care.check_encoders = geometry.check_encoders;
    care.encoders = geometry.encoders;
    care.compensation = read_compensation(r.dictionary("compensation"), problems);
    if (own.none() && care.compensation.active())
        problems.add(validate(care.compensation, geometry.figures));
    problems.add(own);
    return geometry.figures;
}

std::vector<HandTarget> read_path(const std::vector<double>& table, Problems& problems) {
    std::vector<HandTarget> path;
    if (table.size() % 4 != 0)
        problems.add("device.hand.path has " + std::to_string(table.size()) +
                     " numbers; it must hold rows of t_s, x_m, y_m, theta_rad.");
    for (std::size_t i = 0; i + 3 < table.size(); i += 4)
        path.push_back({table[i], Pose(table[i + 1], table[i + 2], table[i + 3])});
    return path;
}

SimulatedHandOptions read_hand(const Dictionary& from, Problems& problems) {
    DictionaryReader r(from, "device.hand.", problems);
    const HandKind kind = r.choice("kind", HandKind::none,
                                   {{"none", HandKind::none},
                                    {"constant_force", HandKind::constant_force},
                                    {"recorded_path", HandKind::recorded_path},
                                    {"target", HandKind::target}});
    SimulatedHandOptions h = kind == HandKind::target ? mouse_hand() : SimulatedHandOptions{};
    h.kind = kind;
    h.mass = r.number("mass", h.mass);
    h.inertia = r.number("inertia", h.inertia);
    h.stiffness = r.number("stiffness", h.stiffness);
    h.rotation_stiffness = r.number("rotation_stiffness", h.rotation_stiffness);
    h.damping_ratio = r.number("damping_ratio", h.damping_ratio);
    h.max_force = r.number("max_force", h.max_force);
    h.max_torque = r.number("max_torque", h.max_torque);
    h.force = r.vec3("force", h.force);
    h.start_time = r.number("start_time", h.start_time);
    h.path = read_path(r.numbers("path"), problems);
    h.interpolation = r.flag("smooth", true) ? PathInterpolation::smooth : PathInterpolation::linear;
    h.repeat = r.flag("repeat", h.repeat);
    r.finish();
    return h;
}

DeviceOptions read_simulated_pantograph(const Dictionary& from, Problems& problems) {
    SimulatedPantographOptions o;
    DeviceCareSettings care;
    DictionaryReader r(from, "device.", problems);
    r.text("kind", "");
    o.geometry = read_linkage(r, care, problems);
    o.gravity = r.vec2("gravity", o.gravity);
    o.inertia_model = r.choice("inertia_model", o.inertia_model,
                               {{"constant", InertiaModel::constant}, {"linkage", InertiaModel::linkage}});
    o.mass = r.number("mass", o.mass);
    o.inertia = r.number("inertia", o.inertia);
    o.viscous_friction = r.number("viscous_friction", o.viscous_friction);
    o.rotation_viscous_friction = r.number("rotation_viscous_friction", o.rotation_viscous_friction);
    o.coulomb_friction = r.number("coulomb_friction", o.coulomb_friction);
    o.rotation_coulomb_friction = r.number("rotation_coulomb_friction", o.rotation_coulomb_friction);
    o.encoder_model = r.choice(
        "encoder_model", o.encoder_model,
        {{"exact", EncoderModel::exact}, {"handle", EncoderModel::handle}, {"joint", EncoderModel::joint}});
    o.encoder_resolution = r.vec3("encoder_resolution", o.encoder_resolution);
    o.command_delay = r.number("command_delay", o.command_delay);
    o.command_delay_steps = r.integer("command_delay_steps", o.command_delay_steps);
    o.reading_delay_steps = r.integer("reading_delay_steps", o.reading_delay_steps);
    o.limit_motors = r.flag("limit_motors", o.limit_motors);
    o.bounded = r.flag("bounded", o.bounded);
    o.measures_force = r.flag("measures_force", o.measures_force);
    o.measures_velocity = r.flag("measures_velocity", o.measures_velocity);
    o.noise = r.vec3("noise", o.noise);
    o.seed = static_cast<std::uint64_t>(std::max(0.0, r.number("seed", 1.0)));
    o.sub_step = r.number("sub_step", o.sub_step);
    o.hand = read_hand(r.dictionary("hand"), problems);
    r.finish();
    problems.add(validate(o));
    if (care.compensation.active() && o.inertia_model == InertiaModel::constant)
        problems.add("device.compensation compensates links and rotors, but device.inertia_model is "
                     "constant. Set it to "
                     "linkage, or take the compensation away.");
    return {o, care};
}

DeviceOptions read_hid_pantograph(const Dictionary& from, Problems& problems) {
    HidPantographOptions o;
    DeviceCareSettings care;
    DictionaryReader r(from, "device.", problems);
    r.text("kind", "");
    o.geometry = read_linkage(r, care, problems);
    const auto id = [&r](const char* key, int fallback) {
        const double given = r.number(key, fallback);
        return std::abs(given) < 1e9 ? static_cast<int>(given) : 0;
    };
    o.vendor = id("vendor_id", o.vendor);
    o.product = id("product_id", o.product);
    o.serial = r.text("serial", o.serial);
    o.residual_limit = r.number("encoder_tolerance", o.residual_limit);
    o.stream.max_joint_speed = r.number("max_joint_speed", o.stream.max_joint_speed);
    r.finish();
    problems.add(validate(o));
    return {o, care};
}

} // namespace

HandPlacement read_placement(const Dictionary& from, Problems& problems) {
    HandPlacement p;
    DictionaryReader r(from, "", problems);
    p.mapping.scale = r.number("mapping_scale", p.mapping.scale);
    p.mapping.rotation = r.number("mapping_rotation", p.mapping.rotation);
    p.mapping.offset = r.vec3("mapping_offset", p.mapping.offset);
    p.clutched = r.flag("clutched", p.clutched);
    p.turn = r.number("turn", p.turn);
    r.finish();
    problems.add(validate(p));
    return p;
}

WorldSettings read_world_settings(const Dictionary& from, Problems& problems) {
    WorldSettings w;
    DictionaryReader r(from, "", problems);
    w.loop.rate_hz = r.number("rate", w.loop.rate_hz);
    w.loop.priority = r.integer("priority", w.loop.priority);
    w.loop.cpu = r.integer("cpu", w.loop.cpu);
    // a rate that has no period is told as it was given
    FigureCheck check;
    if (check.range("rate", w.loop.rate_hz, 250.0, 100000.0, "Hz",
                    "1000 Hz is the default; above 10000 Hz only in lock-step."))
        w.session.step = 1.0 / w.loop.rate_hz;
    w.session.coupling = r.choice("coupling", w.session.coupling,
                                  {{"four_channel", Coupling::four_channel},
                                   {"virtual_coupling", Coupling::virtual_coupling},
                                   {"direct", Coupling::direct}});
    w.session.gains.stiffness = r.vec3("coupling_stiffness", w.session.gains.stiffness);
    w.session.gains.damping = r.vec3("coupling_damping", w.session.gains.damping);
    w.session.mapping.scale = r.number("mapping_scale", w.session.mapping.scale);
    w.session.mapping.rotation = r.number("mapping_rotation", w.session.mapping.rotation);
    w.session.mapping.offset = r.vec3("mapping_offset", w.session.mapping.offset);
    w.session.velocity_window = r.integer("velocity_window", w.session.velocity_window);
    w.session.observer.enabled = r.flag("observer", w.session.observer.enabled);
    w.session.observer.noise = r.number("observer_noise", w.session.observer.noise);
    w.session.observer.mass_error = r.number("observer_mass_error", w.session.observer.mass_error);
    w.session.hidden_inertia = r.number("hidden_inertia", w.session.hidden_inertia);
    if (w.session.hidden_inertia > 0.0)
        w.session.hand_force = HandForce::transparent;
    w.session.passivity_control = r.flag("passivity_control", w.session.passivity_control);
    w.session.arm_at_start = r.flag("arm_at_start", w.session.arm_at_start);
    w.session.hold_at_start = r.flag("hold_at_start", w.session.hold_at_start);
    w.model.contact_mode =
        r.choice("contact", w.model.contact_mode,
                 {{"penalty_impulse", ContactMode::penalty_impulse}, {"penalty", ContactMode::penalty}});
    w.model.integrator = r.choice("integrator", w.model.integrator,
                                  {{"semi_implicit", Integrator::semi_implicit},
                                   {"linearly_implicit", Integrator::linearly_implicit},
                                   {"exact", Integrator::exact}});
    w.model.collision_method = r.choice("collision_method", w.model.collision_method,
                                        {{"poisson", CollisionMethod::poisson},
                                         {"mass_weighted", CollisionMethod::mass_weighted},
                                         {"paper", CollisionMethod::paper}});
    w.whole_scene = r.flag("whole_scene", w.whole_scene);
    w.model.collision_speed = r.number("collision_speed", w.model.collision_speed);
    w.safety = read_safety(r.dictionary("safety"), problems);
    r.finish();
    problems.add(validate(w.session));
    check.range("collision_speed", w.model.collision_speed, 1e-6, 10.0, "m/s",
                "Slower approaches than this give no collision impulse; 0.005 m/s is the default.");
    problems.add(check.take());
    return w;
}

Surface read_surface(const Dictionary& from, const std::string& place, const Surface& fallback,
                     Problems& problems) {
    Surface s;
    DictionaryReader r(from, place, problems);
    s.stiffness = r.number("stiffness", fallback.stiffness);
    s.damping = r.number("damping", fallback.damping);
    s.static_friction = r.number("static_friction", fallback.static_friction);
    s.dynamic_friction = r.number("dynamic_friction", fallback.dynamic_friction);
    s.restitution = r.number("restitution", fallback.restitution);
    r.finish();
    problems.add(validate(s));
    return s;
}

DeviceOptions read_device(const Dictionary& from, Problems& problems) {
    Problems ignored;
    const std::string kind = DictionaryReader(from, "", ignored).text("kind", "");
    if (kind == "hid_pantograph")
        return read_hid_pantograph(from, problems);
    if (!kind.empty() && kind != "simulated_pantograph")
        problems.add("device.kind is \"" + kind +
                     "\", must be one of: simulated_pantograph, hid_pantograph.");
    return read_simulated_pantograph(from, problems);
}

} // namespace haptics
