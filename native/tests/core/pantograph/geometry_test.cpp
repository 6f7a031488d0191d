#include <doctest/doctest.h>

#include <limits>

#include "core/pantograph/poses.hpp"

using namespace haptics;
using haptics::testing::all_presets;

TEST_SUITE("pantograph geometry") {
    TEST_CASE("every preset can be built") {
        for (const PantographGeometry& geometry : all_presets()) {
            const std::vector<FigureError> errors = validate(geometry);
            CHECK(errors.empty());
            for (const FigureError& error : errors)
                MESSAGE(error.message());
        }
    }

    TEST_CASE("a bad figure is named with its value, range and remedy") {
        PantographGeometry geometry = ubc_twin_pantograph();
        geometry.bar[1].distal_length[0] = -0.18;
        const std::vector<FigureError> errors = validate(geometry);
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].problem == FigureProblem::out_of_range);
        CHECK(errors[0].field == "bar[1].distal_length[0]");
        CHECK(errors[0].value == -0.18);
        CHECK(errors[0].message() ==
              "bar[1].distal_length[0] is -0.18 m, must lie between 0.005 and 1 m. Give lengths in meters.");
    }

    TEST_CASE("figures that are not numbers, and figures that do not fit together, are told apart") {
        PantographGeometry broken = pantograph_mk2();
        broken.handle_mass = std::numeric_limits<double>::quiet_NaN();
        REQUIRE(validate(broken).size() == 1);
        CHECK(validate(broken)[0].problem == FigureProblem::not_finite);

        PantographGeometry far = pantograph_mk2();
        far.home = Pose(0.5, 0.0, 0.0);
        REQUIRE(validate(far).size() == 1);
        CHECK(validate(far)[0].problem == FigureProblem::inconsistent);
        CHECK(validate(far)[0].field == "home");

        PantographGeometry merged = ubc_twin_pantograph();
        merged.attachment[1] = merged.attachment[0];
        REQUIRE_FALSE(validate(merged).empty());
        CHECK(validate(merged)[0].field == "attachment");

        CHECK(validate(far)[0].message().find("The arms do not reach the home pose") != std::string::npos);

        PantographGeometry mirrored = pantograph_mk2();
        mirrored.bar[0].end_side = -1;
        REQUIRE(validate(mirrored).size() == 1);
        CHECK(validate(mirrored)[0].message().find("change end_side") != std::string::npos);

        PantographGeometry turned = ubc_twin_pantograph();
        turned.home.z() = 0.5;
        turned.rotation_limit = 0.3;
        REQUIRE(validate(turned).size() == 1);
        CHECK(validate(turned)[0].message().find("rotation_limit") != std::string::npos);

        PantographGeometry bars = pantograph_mk2();
        bars.bar_count = 3;
        REQUIRE(validate(bars).size() == 1);
        CHECK(validate(bars)[0].field == "bar_count");
    }

    TEST_CASE("arms that cannot meet are named once, with the figure that parts them") {
        PantographGeometry wide = pantograph_mk2();
        wide.bar[0].base_spacing = 0.3;
        REQUIRE(validate(wide).size() == 1);
        CHECK(validate(wide)[0].message() == "bar[0].base_spacing is 0.3 m, must lie between 0 and 0.276 m. "
                                             "The two arms cannot meet: lengthen the "
                                             "links or bring the motor axes together.");

        PantographGeometry nested = ubc_twin_pantograph();
        nested.bar[1].proximal_length[0] = 0.03;
        nested.bar[1].distal_length[0] = 0.9;
        REQUIRE(validate(nested).size() == 1);
        CHECK(validate(nested)[0].field == "bar[1].distal_length[0]");
        CHECK(validate(nested)[0].message().find("The two arms cannot meet") != std::string::npos);
    }

    TEST_CASE("an encoder without counts is named") {
        PantographGeometry geometry = haply_2diy_v3();
        geometry.motor.counts_per_revolution = 0.0;
        REQUIRE(validate(geometry).size() == 1);
        CHECK(validate(geometry)[0].message() == "motor.counts_per_revolution is 0 1/rev, must lie between "
                                                 "16 and 1e+09 1/rev. Count all four quadrature "
                                                 "edges over one turn of the joint.");
    }
}
