#include <cmath>
#include <functional>
#include <limits>

#include "dynamics_fixture.hpp"

using namespace haptics;

namespace {

struct Case {
    LinkageError error;
    int link;
    std::function<void(LinkageSpec&)> breaking;
};

const double k_nan = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_CASE("every fault of a linkage is found, named with its link, and has a remedy") {
    const Case cases[] = {
        {LinkageError::no_links, -1, [](LinkageSpec& s) { s.links.clear(); }},
        {LinkageError::too_many_links, -1, [](LinkageSpec& s) { s = shared::chain(65); }},
        {LinkageError::no_freedom, -1,
         [](LinkageSpec& s) {
             for (LinkSpec& link : s.links) {
                 link.joint.kind = JointKind::fixed;
             }
         }},
        {LinkageError::not_finite, 1, [](LinkageSpec& s) { s.links[1].mass = k_nan; }},
        {LinkageError::not_finite, 1, [](LinkageSpec& s) { s.links[1].center.y() = k_nan; }},
        {LinkageError::not_finite, 1,
         [](LinkageSpec& s) { s.links[1].joint.frame.z() = std::numeric_limits<double>::infinity(); }},
        {LinkageError::not_finite, -1, [](LinkageSpec& s) { s.gravity.x() = k_nan; }},
        {LinkageError::not_finite, 2, [](LinkageSpec& s) { s.links[2].joint.upper_limit = k_nan; }},
        {LinkageError::mass_not_positive, 1, [](LinkageSpec& s) { s.links[1].mass = 0.0; }},
        {LinkageError::mass_not_positive, 1, [](LinkageSpec& s) { s.links[1].mass = -1.0; }},
        {LinkageError::inertia_not_positive, 2, [](LinkageSpec& s) { s.links[2].inertia = 0.0; }},
        {LinkageError::parent_missing, 2, [](LinkageSpec& s) { s.links[2].parent = 7; }},
        {LinkageError::parent_missing, 2, [](LinkageSpec& s) { s.links[2].parent = -2; }},
        {LinkageError::cycle, 1, [](LinkageSpec& s) { s.links[1].parent = 2; }},
        {LinkageError::cycle, 1, [](LinkageSpec& s) { s.links[1].parent = 1; }},
        {LinkageError::parent_after_child, 0,
         [](LinkageSpec& s) { s.links[0].parent = 1, s.links[1].parent = -1; }},
        {LinkageError::second_root, 1,
         [](LinkageSpec& s) { s.base = BaseKind::floating, s.links[1].parent = -1; }},
        {LinkageError::limits_out_of_order, 1,
         [](LinkageSpec& s) { s.links[1].joint.lower_limit = 1.0, s.links[1].joint.upper_limit = -1.0; }},
        {LinkageError::limit_stiffness_negative, 1,
         [](LinkageSpec& s) { s.links[1].joint.limit_stiffness = -1.0; }},
        {LinkageError::limit_damping_negative, 1,
         [](LinkageSpec& s) { s.links[1].joint.limit_damping = -1.0; }},
        {LinkageError::damping_negative, 1, [](LinkageSpec& s) { s.links[1].joint.damping = -1.0; }},
        {LinkageError::friction_negative, 1, [](LinkageSpec& s) { s.links[1].joint.friction = -1.0; }},
        {LinkageError::friction_band_not_positive, 1,
         [](LinkageSpec& s) { s.links[1].joint.friction = 1.0, s.links[1].joint.friction_band = 0.0; }},
        {LinkageError::too_large, 1, [](LinkageSpec& s) { s.links[1].joint.damping = 1e30; }},
        {LinkageError::too_large, 2, [](LinkageSpec& s) { s.links[2].joint.limit_stiffness = 1e13; }},
        {LinkageError::spring_stiffness_negative, 1,
         [](LinkageSpec& s) { s.links[1].joint.spring_stiffness = -1.0; }},
    };
    for (const Case& test : cases) {
        LinkageSpec spec = shared::arm();
        test.breaking(spec);
        const auto faults = validate(spec);
        bool found = false;
        for (const LinkageFault& fault : faults) {
            found = found || (fault.error == test.error && fault.link == test.link);
            const std::string text = describe(fault);
            CHECK(text.find("; ") != std::string::npos);
            CHECK(text.find(fault.property) != std::string::npos);
        }
        CAPTURE(static_cast<int>(test.error));
        CHECK(found);
        LinkageModel model;
        CHECK_FALSE(build_model(spec, model).empty());
        CHECK(model.body_count == 0);
    }
}

TEST_CASE("sound linkages have no fault") {
    CHECK(validate(shared::door()).empty());
    CHECK(validate(shared::drawer()).empty());
    CHECK(validate(shared::arm()).empty());
    CHECK(validate(shared::rigid_tool()).empty());
    CHECK(validate(shared::chain(64)).empty());
    CHECK(validate(shared::chain(64, BaseKind::floating)).empty());
}

TEST_CASE("the message of a fault says what, the value, where and the remedy") {
    LinkageSpec spec = shared::arm();
    spec.links[1].mass = -0.5;
    const auto faults = validate(spec);
    REQUIRE(faults.size() == 1);
    CHECK(describe(faults[0]) == "link 1: mass is -0.5; give the link a mass above 0 kg.");
}
