extends GutTest
## Surfaces: figures, presets, and which one a body has.

const SurfaceReader := preload("res://addons/haptics/environment/surface_reader.gd")


func test_the_default_is_the_papers_wall() -> void:
	var surface := HapticSurface.new()
	assert_eq(surface.stiffness, 15000.0)
	assert_eq(surface.damping, 20.0)
	assert_eq(surface.preset, HapticSurface.Preset.RIGID)


func test_a_preset_fills_the_figures_and_a_change_makes_it_custom() -> void:
	var surface := HapticSurface.create(HapticSurface.Preset.RUBBER)
	assert_eq(surface.preset, HapticSurface.Preset.RUBBER)
	assert_gt(surface.restitution, 0.0)
	surface.stiffness += 1.0
	assert_eq(surface.preset, HapticSurface.Preset.CUSTOM)


func test_every_preset_is_one_that_the_native_side_takes() -> void:
	var native := HapticWorld2D.Gateway.new()
	for preset: int in range(1, HapticSurface.Preset.size()):
		var surface := HapticSurface.create(preset as HapticSurface.Preset)
		assert_eq(surface.preset as int, preset)
		var disc := {
			"id": 1, "kind": "circle", "points": PackedFloat64Array([0, 0]), "radius": 0.01
		}
		var body := {"kind": "fixed", "surface": surface.to_settings(), "shapes": [disc]}
		assert_eq(native.set_body(1, body), PackedStringArray())


func test_frequency_and_damping_ratio_give_back_what_was_set() -> void:
	var surface := HapticSurface.new()
	surface.set_frequency(0.3, 40.0, 0.7)
	assert_almost_eq(surface.get_frequency(0.3), 40.0, 1e-9)
	assert_almost_eq(surface.get_damping_ratio(0.3), 0.7, 1e-9)
	# omega squared times mass
	assert_almost_eq(surface.stiffness, 0.3 * pow(TAU * 40.0, 2.0), 1e-6)


func test_a_change_is_told() -> void:
	var surface := HapticSurface.new()
	watch_signals(surface)
	surface.damping = 3.0
	assert_signal_emitted(surface, "changed")


class TestWhichOneABodyHas:
	extends GutTest

	var _default := HapticSurface.new()

	func test_its_own_property_comes_first() -> void:
		var wall: HapticWall2D = autofree(HapticWall2D.new())
		wall.surface = HapticSurface.new()
		wall.set_meta(SurfaceReader.NAME, HapticSurface.new())
		assert_same(SurfaceReader.find(wall, _default), wall.surface)

	func test_then_its_metadata() -> void:
		var body: StaticBody2D = autofree(StaticBody2D.new())
		var noted := HapticSurface.new()
		body.set_meta(SurfaceReader.NAME, noted)
		assert_same(SurfaceReader.find(body, _default), noted)

	func test_then_the_worlds_default() -> void:
		var body: StaticBody2D = autofree(StaticBody2D.new())
		assert_same(SurfaceReader.find(body, _default), _default)

	func test_and_the_papers_wall_without_one() -> void:
		var body: StaticBody2D = autofree(StaticBody2D.new())
		assert_eq(SurfaceReader.find(body, null).stiffness, 15000.0)
