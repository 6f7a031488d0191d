#include <haptics/classes/geometry_reader.hpp>
#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/presets.hpp>
#include <haptics/core/pantograph/torque_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptics {

using namespace godot;

namespace {

constexpr std::array<const char*, 2> k_bars{"first", "second"};
constexpr std::array<const char*, 2> k_legs{"left", "right"};

struct NamedPreset {
    const char* name;
    PantographGeometry (*make)();
};
constexpr std::array<NamedPreset, 4> k_presets{{{"ubc_twin_pantograph", ubc_twin_pantograph},
                                                {"pantograph_mk2", pantograph_mk2},
                                                {"haply_2diy_v2", haply_2diy_v2},
                                                {"haply_2diy_v3", haply_2diy_v3}}};

std::string of_leg(std::size_t leg, const char* figure) {
    return std::string(k_legs[leg]) + "_" + figure;
}

// the core's names of figures in the words of the resource
std::string property_name(std::string field) {
    const auto replace = [&field](const std::string& from, const std::string& to) {
        const std::size_t at = field.find(from);
        if (at != std::string::npos)
            field.replace(at, from.size(), to);
    };
    for (std::size_t b = 0; b < 2; ++b) {
        const std::string index = "[" + std::to_string(b) + "]";
        replace("bar" + index, k_bars[b]);
        replace("attachment" + index, std::string(k_bars[b]) + "_attachment");
        for (const char* figure : {"proximal_length", "distal_length"})
            replace(figure + index, of_leg(b, figure));
        replace("elbow_side" + index, of_leg(b, "elbow"));
    }
    replace("base_", "");
    replace("motor.", "");
    replace("gear_ratio", "gear_ratios");
    replace("encoder_offset", "encoder_offsets");
    replace("encoder_direction", "encoder_directions");
    replace("home.theta", "home_angle");
    replace("bar_count", "kind");
    if (field == "attachment")
        field = "second_attachment";
    return field;
}

// one line that names the resource
void tell(const std::vector<FigureError>& errors, const std::string& name, Problems& problems) {
    for (FigureError error : errors) {
        error.field = property_name(error.field);
        problems.add(name + ": " + error.message());
    }
}

void read_bar(const Dictionary& from, const std::string& place, FiveBarGeometry& bar, Problems& problems) {
    DictionaryReader r(from, place, problems);
    bar.base_center = r.vec2("center", bar.base_center);
    bar.base_angle = r.number("angle", bar.base_angle);
    bar.base_spacing = r.number("spacing", bar.base_spacing);
    for (std::size_t k = 0; k < 2; ++k) {
        bar.proximal_length[k] = r.number(of_leg(k, "proximal_length").c_str(), bar.proximal_length[k]);
        bar.distal_length[k] = r.number(of_leg(k, "distal_length").c_str(), bar.distal_length[k]);
        bar.elbow_side[k] =
            r.choice(of_leg(k, "elbow").c_str(), bar.elbow_side[k], {{"left", +1}, {"right", -1}});
    }
    bar.end_side = r.choice("end_side", bar.end_side, {{"left", +1}, {"right", -1}});
    bar.proximal_mass = r.number("proximal_mass", bar.proximal_mass);
    bar.proximal_center = r.number("proximal_center", bar.proximal_center);
    bar.proximal_inertia = r.number("proximal_inertia", bar.proximal_inertia);
    bar.distal_mass = r.number("distal_mass", bar.distal_mass);
    bar.distal_center = r.number("distal_center", bar.distal_center);
    bar.distal_inertia = r.number("distal_inertia", bar.distal_inertia);
    r.finish();
}

// one number for each motor
template <typename Values>
void read_axes(DictionaryReader& r, const char* key, int motors, Values& values) {
    const std::vector<double> found = r.numbers(key, static_cast<std::size_t>(motors));
    for (std::size_t i = 0; i < found.size(); ++i)
        values[i] = static_cast<typename Values::value_type>(found[i]);
}

DeviceGeometry read_figures(const Dictionary& from, Problems& problems) {
    DeviceGeometry d;
    PantographGeometry& g = d.figures = pantograph_mk2();
    std::string name = "HapticPantographGeometry";
    if (from.has("name"))
        name = Variant(from["name"]).stringify().utf8();
    Problems own;
    DictionaryReader r(from, name + ": ", own);
    r.text("name", "");
    g.bar_count = r.choice("kind", 1, {{"single", 1}, {"twin", 2}});
    for (std::size_t b = 0; b < static_cast<std::size_t>(g.bar_count); ++b) {
        if (!r.has(k_bars[b]))
            own.add(name + ": " + k_bars[b] + " is missing. Give it a HapticFiveBar, or choose a preset.");
        read_bar(r.dictionary(k_bars[b]), name + ": " + k_bars[b] + ".", g.bar[b], own);
        const std::string attachment = std::string(k_bars[b]) + "_attachment";
        g.attachment[b] = r.vec2(attachment.c_str(), Vec2::Zero());
    }
    g.motor.torque_limit = r.number("torque_limit", g.motor.torque_limit);
    g.motor.torque_constant = r.number("torque_constant", g.motor.torque_constant);
    g.motor.rotor_inertia = r.number("rotor_inertia", g.motor.rotor_inertia);
    g.motor.viscous_friction = r.number("viscous_friction", g.motor.viscous_friction);
    g.motor.coulomb_friction = r.number("coulomb_friction", g.motor.coulomb_friction);
    g.motor.counts_per_revolution = r.number("counts_per_revolution", g.motor.counts_per_revolution);
    read_axes(r, "gear_ratios", g.motors(), g.gear_ratio);
    read_axes(r, "encoder_offsets", g.motors(), g.encoder_offset);
    read_axes(r, "encoder_directions", g.motors(), g.encoder_direction);
    g.handle_mass = r.number("handle_mass", g.handle_mass);
    g.handle_inertia = r.number("handle_inertia", g.handle_inertia);
    g.rotation_limit = r.number("rotation_limit", g.rotation_limit);
    g.home.head<2>() = r.vec2("home", g.home.head<2>());
    g.home.z() = r.number("home_angle", g.home.z());
    d.check_encoders = r.flag("check_encoders", d.check_encoders);
    d.encoders.reading_error = r.number("reading_error", d.encoders.reading_error);
    d.encoders.offset_tolerance = r.number("offset_tolerance", d.encoders.offset_tolerance);
    d.encoders.length_tolerance = r.number("length_tolerance", d.encoders.length_tolerance);
    r.finish();
    if (own.none()) {
        tell(validate(g), name, own);
        tell(validate(d.encoders), name, own);
    }
    problems.add(own);
    return d;
}

PackedFloat64Array pair(const Vec2& v) {
    return {v.x(), v.y()};
}

const char* side(int sign) {
    return sign > 0 ? "left" : "right";
}

Dictionary describe_bar(const FiveBarGeometry& bar) {
    Dictionary d;
    d["center"] = pair(bar.base_center);
    d["angle"] = bar.base_angle;
    d["spacing"] = bar.base_spacing;
    for (std::size_t k = 0; k < 2; ++k) {
        d[of_leg(k, "proximal_length").c_str()] = bar.proximal_length[k];
        d[of_leg(k, "distal_length").c_str()] = bar.distal_length[k];
        d[of_leg(k, "elbow").c_str()] = side(bar.elbow_side[k]);
    }
    d["end_side"] = side(bar.end_side);
    d["proximal_mass"] = bar.proximal_mass;
    d["proximal_center"] = bar.proximal_center;
    d["proximal_inertia"] = bar.proximal_inertia;
    d["distal_mass"] = bar.distal_mass;
    d["distal_center"] = bar.distal_center;
    d["distal_inertia"] = bar.distal_inertia;
    return d;
}

template <typename Values>
PackedFloat64Array axes(const Values& values, int motors) {
    PackedFloat64Array out;
    for (std::size_t i = 0; i < static_cast<std::size_t>(motors); ++i)
        out.push_back(static_cast<double>(values[i]));
    return out;
}

} // namespace

bool find_preset(const std::string& name, PantographGeometry& geometry) {
    for (const NamedPreset& preset : k_presets)
        if (name == preset.name) {
            geometry = preset.make();
            return true;
        }
    return false;
}

DeviceGeometry read_geometry(DictionaryReader& device, Problems& problems) {
    const Variant found = device.name_or_dictionary("geometry");
    if (found.get_type() == Variant::DICTIONARY)
        return read_figures(found.to<Dictionary>(), problems);
    DeviceGeometry d;
    d.figures = ubc_twin_pantograph();
    const std::string name = found.get_type() == Variant::NIL ? "" : found.to<String>().utf8();
    if (!name.empty() && !find_preset(name, d.figures)) {
        std::string known;
        for (const NamedPreset& preset : k_presets)
            known += (known.empty() ? "" : ", ") + std::string(preset.name);
        problems.add("device.geometry is \"" + name + "\", must be figures or one of: " + known + ".");
    }
    return d;
}

Dictionary describe_geometry(const PantographGeometry& g) {
    Dictionary d;
    d["kind"] = g.bar_count == 2 ? "twin" : "single";
    for (std::size_t b = 0; b < static_cast<std::size_t>(g.bar_count); ++b) {
        d[k_bars[b]] = describe_bar(g.bar[b]);
        d[(std::string(k_bars[b]) + "_attachment").c_str()] = pair(g.attachment[b]);
    }
    d["torque_limit"] = g.motor.torque_limit;
    d["torque_constant"] = g.motor.torque_constant;
    d["rotor_inertia"] = g.motor.rotor_inertia;
    d["viscous_friction"] = g.motor.viscous_friction;
    d["coulomb_friction"] = g.motor.coulomb_friction;
    d["counts_per_revolution"] = g.motor.counts_per_revolution;
    d["gear_ratios"] = axes(g.gear_ratio, g.motors());
    d["encoder_offsets"] = axes(g.encoder_offset, g.motors());
    d["encoder_directions"] = axes(g.encoder_direction, g.motors());
    d["handle_mass"] = g.handle_mass;
    d["handle_inertia"] = g.handle_inertia;
    d["rotation_limit"] = g.rotation_limit;
    d["home"] = pair(g.home.head<2>());
    d["home_angle"] = g.home.z();
    return d;
}

Dictionary derived_figures(const PantographGeometry& g) {
    Dictionary d;
    if (!validate(g).empty())
        return d;
    const PantographKinematics kinematics(g);
    const PantographState state = kinematics.locate(g.home);
    const WorkspaceReport workspace = kinematics.workspace(g.home, state);
    const Mat3 mass = handle_mass_matrix(kinematics, state);
    const Eigen::SelfAdjointEigenSolver<Mat2> along(mass.topLeftCorner<2, 2>());
    d["mass_kg"] = along.eigenvalues()[1];
    d["inertia_kg_m2"] = mass(2, 2);
    d["reach_margin_m"] = workspace.reach_margin;
    d["singularity"] = workspace.singularity;
    // the direction in which the motors give least, and what one count is at the handle
    double force = 1.0e9;
    for (int degree = 0; degree < 360; degree += 2) {
        const double angle = degree * std::numbers::pi / 180.0;
        const Wrench wrench(1.0e3 * std::cos(angle), 1.0e3 * std::sin(angle), 0.0);
        force = std::min(force, 1.0e3 * joint_torques(kinematics, state, wrench).scale);
    }
    d["least_force_n"] = force;
    const double count = 2.0 * std::numbers::pi / g.motor.counts_per_revolution;
    const Eigen::Matrix<double, 3, 4> twist = kinematics.jacobian(state);
    d["resolution_m"] = count * twist.topRows<2>().colwise().norm().maxCoeff();
    d["resolution_rad"] = count * twist.row(2).cwiseAbs().maxCoeff();
    const EncoderCheck check(kinematics);
    JointVector angles;
    kinematics.inverse(g.home, angles);
    double slip = 0.0;
    for (int i = 0; i < g.motors(); ++i)
        slip = std::max(slip, check.smallest_slip(angles, i));
    // none for a single five-bar: it cannot tell
    if (check.possible())
        d["smallest_slip_counts"] = slip / count;
    return d;
}

} // namespace haptics
