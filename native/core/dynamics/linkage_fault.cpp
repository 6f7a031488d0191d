#include <haptics/core/dynamics/linkage_fault.hpp>

#include <cmath>
#include <cstdio>

namespace haptics {
namespace {

using Faults = std::vector<LinkageFault>;

/// Largest figure of a joint or a link, in SI units.
constexpr double k_most = 1e12;

void need_finite(Faults& faults, int link, const char* property, double value) {
    if (!std::isfinite(value)) {
        faults.push_back({LinkageError::not_finite, link, value, property});
    }
}

/// Finite and > 0 (or >= 0 with `zero_allowed`), at most k_most.
void need_positive(Faults& faults, LinkageError error, int link, const char* property, double value,
                   bool zero_allowed) {
    if (!std::isfinite(value)) {
        faults.push_back({LinkageError::not_finite, link, value, property});
    } else if (value < 0.0 || (value == 0.0 && !zero_allowed)) {
        faults.push_back({error, link, value, property});
    } else if (value > k_most) {
        faults.push_back({LinkageError::too_large, link, value, property});
    }
}

void check_parent(Faults& faults, const LinkageSpec& spec, int number) {
    const int count = static_cast<int>(spec.links.size());
    const auto parent_of = [&](int link) { return spec.links[static_cast<std::size_t>(link)].parent; };
    const int parent = parent_of(number);
    if (parent < -1 || parent >= count) {
        faults.push_back({LinkageError::parent_missing, number, static_cast<double>(parent), "parent"});
        return;
    }
    if (parent == -1) {
        if (spec.base == BaseKind::floating && number != 0) {
            faults.push_back({LinkageError::second_root, number, -1.0, "parent"});
        }
        return;
    }
    if (parent < number) {
        return;
    }
    // the parent stands after its child: a cycle when the chain of parents comes back
    int ancestor = parent;
    for (int step = 0; step < count && ancestor >= 0 && ancestor < count; ++step) {
        if (ancestor == number) {
            faults.push_back({LinkageError::cycle, number, static_cast<double>(parent), "parent"});
            return;
        }
        ancestor = parent_of(ancestor);
    }
    faults.push_back({LinkageError::parent_after_child, number, static_cast<double>(parent), "parent"});
}

void check_joint(Faults& faults, const JointSpec& joint, int number) {
    need_finite(faults, number, "joint.frame.x", joint.frame.x());
    need_finite(faults, number, "joint.frame.y", joint.frame.y());
    need_finite(faults, number, "joint.frame.theta", joint.frame.z());
    if (joint.kind == JointKind::fixed) {
        return;
    }
    if (std::isnan(joint.lower_limit) || std::isnan(joint.upper_limit)) {
        const bool lower = std::isnan(joint.lower_limit);
        faults.push_back({LinkageError::not_finite, number, lower ? joint.lower_limit : joint.upper_limit,
                          lower ? "joint.lower_limit" : "joint.upper_limit"});
    } else if (joint.lower_limit >= joint.upper_limit) {
        faults.push_back({LinkageError::limits_out_of_order, number, joint.lower_limit, "joint.lower_limit"});
    }
    need_positive(faults, LinkageError::limit_stiffness_negative, number, "joint.limit_stiffness",
                  joint.limit_stiffness, true);
    need_positive(faults, LinkageError::limit_damping_negative, number, "joint.limit_damping",
                  joint.limit_damping, true);
    need_positive(faults, LinkageError::damping_negative, number, "joint.damping", joint.damping, true);
    need_positive(faults, LinkageError::friction_negative, number, "joint.friction", joint.friction, true);
    need_positive(faults, LinkageError::friction_band_not_positive, number, "joint.friction_band",
                  joint.friction_band, joint.friction == 0.0);
    need_positive(faults, LinkageError::spring_stiffness_negative, number, "joint.spring_stiffness",
                  joint.spring_stiffness, true);
    need_finite(faults, number, "joint.spring_rest", joint.spring_rest);
}

const char* remedy(LinkageError error) {
    switch (error) {
    case LinkageError::no_links:
        return "add at least one link";
    case LinkageError::too_many_links:
        return "use at most 64 links, or join some of them with fixed joints into one";
    case LinkageError::no_freedom:
        return "make at least one joint revolute or prismatic, or the base floating";
    case LinkageError::not_finite:
        return "give a finite number";
    case LinkageError::mass_not_positive:
        return "give the link a mass above 0 kg";
    case LinkageError::inertia_not_positive:
        return "give the link a moment of inertia above 0 kg m^2 (a rod: mass * length^2 / 12)";
    case LinkageError::parent_missing:
        return "name an existing link, or -1 for the scene";
    case LinkageError::cycle:
        return "links form a tree: attach one link of the loop to another parent";
    case LinkageError::parent_after_child:
        return "list the parent before its children";
    case LinkageError::second_root:
        return "a floating linkage has one link without parent, link 0: attach this one to a link";
    case LinkageError::limits_out_of_order:
        return "set the lower limit below the upper limit, or use a fixed joint";
    case LinkageError::limit_stiffness_negative:
    case LinkageError::limit_damping_negative:
    case LinkageError::damping_negative:
    case LinkageError::friction_negative:
    case LinkageError::spring_stiffness_negative:
        return "use 0 or more";
    case LinkageError::too_large:
        return "use at most 1e12";
    case LinkageError::friction_band_not_positive:
        return "use a speed above 0, such as 0.001";
    }
    return "";
}

} // namespace

std::vector<LinkageFault> validate(const LinkageSpec& spec) {
    Faults faults;
    const int count = static_cast<int>(spec.links.size());
    if (count == 0) {
        faults.push_back({LinkageError::no_links, -1, 0.0, "links"});
    }
    if (count > k_max_links) {
        faults.push_back({LinkageError::too_many_links, -1, static_cast<double>(count), "links"});
    }
    need_finite(faults, -1, "gravity.x", spec.gravity.x());
    need_finite(faults, -1, "gravity.y", spec.gravity.y());
    bool moves = spec.base == BaseKind::floating;
    for (int number = 0; number < count; ++number) {
        const LinkSpec& link = spec.links[static_cast<std::size_t>(number)];
        need_positive(faults, LinkageError::mass_not_positive, number, "mass", link.mass, false);
        need_positive(faults, LinkageError::inertia_not_positive, number, "inertia", link.inertia, false);
        need_finite(faults, number, "center.x", link.center.x());
        need_finite(faults, number, "center.y", link.center.y());
        check_parent(faults, spec, number);
        if (number > 0 || spec.base == BaseKind::grounded) {
            check_joint(faults, link.joint, number);
            moves = moves || link.joint.kind != JointKind::fixed;
        }
    }
    if (count > 0 && !moves) {
        faults.push_back({LinkageError::no_freedom, -1, 0.0, "links"});
    }
    return faults;
}

std::string describe(const LinkageFault& fault) {
    char text[256];
    if (fault.link < 0) {
        std::snprintf(text, sizeof(text), "linkage: %s is %g; %s.", fault.property, fault.value,
                      remedy(fault.error));
    } else {
        std::snprintf(text, sizeof(text), "link %d: %s is %g; %s.", fault.link, fault.property, fault.value,
                      remedy(fault.error));
    }
    return text;
}

} // namespace haptics
