#pragma once
/// Pantograph geometries to and from Dictionaries. Their keys are the property names of the resource
/// HapticPantographGeometry, and so are the names in messages.

#include <haptics/classes/dictionary_reader.hpp>
#include <haptics/core/pantograph/geometry.hpp>
#include <haptics/core/safety/encoder_check.hpp>

#include <string>

namespace haptics {

/// A geometry, and what its device may be off by.
struct DeviceGeometry {
    PantographGeometry figures;
    bool check_encoders{true};
    EncoderCheckSettings encoders{};
};

/// The preset of that name; false when there is none.
bool find_preset(const std::string& name, PantographGeometry& geometry);

/// Key `geometry` of a device: the name of a preset, or a Dictionary of figures (every key may be left out
/// and is then that of the Pantograph Mk-II; a twin needs both five-bars). Validated.
DeviceGeometry read_geometry(DictionaryReader& device, Problems& problems);

/// All figures of a geometry, as read_geometry takes them.
godot::Dictionary describe_geometry(const PantographGeometry& geometry);

/// Figures that follow from a geometry, at its home pose; names carry the unit. Empty when it is unusable.
godot::Dictionary derived_figures(const PantographGeometry& geometry);

} // namespace haptics
