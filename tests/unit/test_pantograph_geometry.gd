extends GutTest
## The resource with all figures of a pantograph: presets, bad figures, and a simulated device that
## has them.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Checks := preload("res://addons/haptics/nodes/checks.gd")
const Geometry := preload("res://addons/haptics/resources/haptic_pantograph_geometry.gd")

const PRESETS: Array[HapticPantographGeometry.Preset] = [
	Geometry.Preset.UBC_TWIN_PANTOGRAPH,
	Geometry.Preset.PANTOGRAPH_MK2,
	Geometry.Preset.HAPLY_2DIY_V2,
	Geometry.Preset.HAPLY_2DIY_V3
]


func _first_problem(geometry: HapticPantographGeometry) -> String:
	var problems := geometry.get_problems()
	assert_eq(problems.size(), 1, "one message: %s" % problems)
	return problems[0] if not problems.is_empty() else ""


class TestPresets:
	extends "res://tests/unit/test_pantograph_geometry.gd"

	func test_every_preset_can_be_built_and_knows_itself(
		chosen: HapticPantographGeometry.Preset = use_parameters(PRESETS)
	) -> void:
		var geometry := HapticPantographGeometry.create(chosen)
		assert_eq(geometry.get_problems(), PackedStringArray())
		assert_eq(geometry.preset, chosen)

	func test_the_defaults_are_the_pantograph_mk2() -> void:
		var geometry := HapticPantographGeometry.new()
		assert_eq(geometry.preset, Geometry.Preset.PANTOGRAPH_MK2)
		assert_eq(geometry.get_motor_count(), 2)

	func test_published_figures_are_those_published() -> void:
		var mk2 := HapticPantographGeometry.create(Geometry.Preset.PANTOGRAPH_MK2)
		assert_eq(mk2.first.left_proximal_length, 0.063)
		assert_eq(mk2.first.right_distal_length, 0.075)
		assert_eq(mk2.first.spacing, 0.025)
		var v2 := HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V2)
		assert_eq(v2.first.spacing, 0.0)
		assert_eq(v2.counts_per_revolution, 10752.0)
		var v3 := HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V3)
		assert_eq(v3.first.left_proximal_length, 0.07)
		assert_eq(v3.first.left_distal_length, 0.09)
		assert_eq(v3.first.spacing, 0.038)
		assert_eq(v3.counts_per_revolution, 4880.0)
		assert_eq(v3.torque_limit, 0.123)
		assert_almost_eq(rad_to_deg(v3.encoder_offsets[0]), 168.0, 1e-9)
		assert_almost_eq(rad_to_deg(v3.encoder_offsets[1]), 12.0, 1e-9)
		# worst direction in the middle of its workspace
		assert_almost_eq(v3.get_figures()["least_force_n"] as float, 1.7, 0.09)

	func test_the_twin_has_four_motors_and_sees_its_encoders_slip() -> void:
		var twin := HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		assert_eq(twin.get_motor_count(), 4)
		assert_eq(twin.encoder_offsets.size(), 4)
		assert_between(twin.get_figures()["smallest_slip_counts"] as float, 3.0, 8.0)
		var single := HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V3)
		assert_does_not_have(single.get_figures(), "smallest_slip_counts")

	func test_one_changed_figure_makes_it_custom() -> void:
		var geometry := HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V3)
		geometry.first.left_distal_length = 0.091
		assert_eq(geometry.preset, Geometry.Preset.CUSTOM)
		assert_eq(geometry.get_problems(), PackedStringArray())

	func test_a_preset_replaces_what_was_there() -> void:
		var geometry := HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		geometry.first.left_proximal_length = 0.2
		geometry.preset = Geometry.Preset.HAPLY_2DIY_V2
		assert_eq(geometry.preset, Geometry.Preset.HAPLY_2DIY_V2)
		assert_null(geometry.second)

	func test_it_survives_being_saved() -> void:
		var path := "user://geometry_test.tres"
		var geometry := HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		geometry.handle_mass = 0.07
		assert_eq(ResourceSaver.save(geometry, path), OK)
		var loaded: HapticPantographGeometry = ResourceLoader.load(
			path, "", ResourceLoader.CACHE_MODE_IGNORE
		)
		var before := geometry.to_settings()
		var after := loaded.to_settings()
		before.erase("name")
		after.erase("name")
		# a text resource holds about 15 digits
		assert_eq(_lost(before, after), PackedStringArray())
		assert_eq(loaded.get_problems(), PackedStringArray())
		DirAccess.remove_absolute(path)

	# keys whose value has changed by more than a part in 1e14
	func _lost(before: Dictionary, after: Dictionary) -> PackedStringArray:
		var keys := PackedStringArray()
		if before.size() != after.size():
			keys.append("size")
		for key: String in before:
			var was: Variant = before[key]
			var found: Variant = after.get(key)
			if was is Dictionary and found is Dictionary:
				keys.append_array(_lost(was as Dictionary, found as Dictionary))
			elif was is float and found is float:
				if absf((found as float) - (was as float)) > 1e-14 * absf(was as float):
					keys.append(key)
			elif was != found:
				keys.append(key)
		return keys


class TestBadFigures:
	extends "res://tests/unit/test_pantograph_geometry.gd"

	var _geometry: HapticPantographGeometry

	func before_each() -> void:
		_geometry = HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V3)

	func test_a_link_without_length() -> void:
		_geometry.first.left_proximal_length = 0.0
		assert_eq(
			_first_problem(_geometry),
			(
				"HapticPantographGeometry: first.left_proximal_length is 0 m, must lie between 0.005"
				+ " and 1 m. Give lengths in meters."
			)
		)

	func test_a_link_of_negative_length_in_a_named_resource() -> void:
		_geometry.resource_name = "bench"
		_geometry.first.right_distal_length = -0.09
		assert_string_starts_with(
			_first_problem(_geometry),
			'HapticPantographGeometry "bench": first.right_distal_length is -0.09 m, must lie'
		)

	func test_a_link_whose_length_is_not_a_number() -> void:
		_geometry.first.left_distal_length = NAN
		assert_string_contains(_first_problem(_geometry), "which is not a number")

	func test_an_encoder_without_counts() -> void:
		_geometry.counts_per_revolution = 0.0
		assert_eq(
			_first_problem(_geometry),
			(
				"HapticPantographGeometry: counts_per_revolution is 0 1/rev, must lie between 16 and"
				+ " 1e+09 1/rev. Count all four quadrature edges over one turn of the joint."
			)
		)

	func test_arms_that_cannot_meet() -> void:
		_geometry.first.spacing = 0.4
		assert_string_contains(
			_first_problem(_geometry), "first.spacing is 0.4 m, must lie between 0"
		)
		assert_string_contains(_first_problem(_geometry), "The two arms cannot meet: lengthen")

	func test_a_home_out_of_reach() -> void:
		_geometry.home = Vector2(0.5, 0.0)
		assert_string_contains(_first_problem(_geometry), "The arms do not reach the home pose")

	func test_a_wrong_count_of_gears() -> void:
		_geometry.gear_ratios = [1.0]
		assert_string_contains(_first_problem(_geometry), "gear_ratios has 1 numbers, must have 2.")

	func test_a_twin_without_its_second_five_bar() -> void:
		_geometry.kind = HapticPantographGeometry.Kind.TWIN
		assert_string_contains(
			_first_problem(_geometry), "second is missing. Give it a HapticFiveBar"
		)

	func test_a_twin_whose_second_five_bar_is_wrong() -> void:
		var twin := HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		twin.second.proximal_mass = -1.0
		twin.second_attachment = twin.first_attachment
		assert_string_contains(_first_problem(twin), "second.proximal_mass is -1 kg")
		twin.second.proximal_mass = 0.03
		assert_string_contains(
			_first_problem(twin), "Let the two five-bars hold the handle at two different points."
		)

	func test_tolerances_out_of_range() -> void:
		_geometry.reading_error = 0.1
		assert_string_contains(_first_problem(_geometry), "reading_error is 0.1 counts")


class TestDevice:
	extends "res://tests/unit/test_pantograph_geometry.gd"

	var _world: HapticWorld2D
	var _device: HapticSimulatedPantograph

	func before_all() -> void:
		Scene.hurry()

	func after_all() -> void:
		Scene.calm_down()

	func before_each() -> void:
		_world = autofree(Scene.make_world())
		_device = _world.device

	func _run(frames: int = 3) -> void:
		add_child_autofree(Scene.gather([_world, Scene.make_tool()]))
		await wait_physics_frames(frames)

	func test_a_geometry_that_cannot_be_built_is_said_once_and_stops_the_world() -> void:
		_device.geometry = HapticPantographGeometry.create(Geometry.Preset.PANTOGRAPH_MK2)
		_device.geometry.first.left_proximal_length = -0.063
		await _run()
		assert_push_error_count(1)
		assert_false(_world.is_running())
		# the same as a configuration warning
		var warning := Checks.of_world(_world)
		assert_eq(warning.size(), 1)
		assert_string_contains(warning[0], "first.left_proximal_length is -0.063 m")

	func test_a_sound_custom_geometry_says_nothing_and_runs() -> void:
		_device.geometry = HapticPantographGeometry.create(Geometry.Preset.HAPLY_2DIY_V3)
		_device.geometry.first.left_distal_length = 0.095
		_device.inertia_model = HapticSimulatedPantograph.InertiaModel.LINKAGE
		await _run()
		assert_true(_world.is_running())
		assert_eq(Checks.of_world(_world), PackedStringArray())

	func test_the_encoders_of_the_geometry_are_what_is_read() -> void:
		# 32 counts a turn show nothing of what fine ones show: the handle comes in a few large steps
		var places: PackedInt32Array = []
		for counts: float in [32.0, 1e6]:
			_world = Scene.make_world()
			_world.arm_at_start = false
			_device = _world.device
			_device.hand = Scene.make_path([[0.0, 0.0, 0.0, 0.0], [1.0, 0.03, 0.01, 0.0]])
			_device.hand_unattended = null
			_device.geometry = HapticPantographGeometry.create(Geometry.Preset.PANTOGRAPH_MK2)
			_device.geometry.counts_per_revolution = counts
			_device.encoder_model = HapticSimulatedPantograph.EncoderModel.JOINT
			var scene: Node = add_child_autofree(Scene.gather([_world, Scene.make_tool()]))
			var seen: Dictionary[Vector2, bool] = {}
			for tick: int in 60:
				await wait_physics_frames(1)
				seen[_world.get_handle().origin] = true
			places.append(seen.size())
			scene.free()
		assert_between(places[0], 2, 12)
		assert_gt(places[1], 30)

	func test_a_weaker_motor_gives_less_force() -> void:
		# a hand that pushes into a wall with 2 N
		var forces: PackedFloat64Array = []
		for torque: float in [0.15, 0.02]:
			_world = Scene.make_world(Vector2(0, 2), 0.7)
			_device = _world.device
			_device.geometry = HapticPantographGeometry.create(Geometry.Preset.PANTOGRAPH_MK2)
			_device.geometry.torque_limit = torque
			var scene: Node = add_child_autofree(
				Scene.gather(
					[_world, Scene.make_tool(), Scene.make_wall(Vector2(0, 70), Vector2(480, 40))]
				)
			)
			await wait_physics_frames(150)
			forces.append(_world.get_statistics()["max_force_n"])
			scene.free()
		assert_gt(forces[0], 1.9)
		# an eighth or so of the torque
		assert_between(forces[1], 0.2, 0.5)

	func test_heavier_links_make_a_heavier_handle() -> void:
		_device.inertia_model = HapticSimulatedPantograph.InertiaModel.LINKAGE
		_device.geometry = HapticPantographGeometry.create(Geometry.Preset.PANTOGRAPH_MK2)
		var light := _device.moving_mass(true)
		_device.geometry.first.distal_mass = 0.2
		assert_gt(_device.moving_mass(true), light + 0.05)

	func test_a_device_without_a_geometry_is_the_twin() -> void:
		_device.inertia_model = HapticSimulatedPantograph.InertiaModel.LINKAGE
		var own := _device.moving_mass(true)
		_device.geometry = HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		assert_almost_eq(_device.moving_mass(true), own, 1e-12)


class TestCompensation:
	extends "res://tests/unit/test_pantograph_geometry.gd"

	var _world: HapticWorld2D
	var _device: HapticSimulatedPantograph

	func before_all() -> void:
		Scene.hurry()

	func after_all() -> void:
		Scene.calm_down()

	func before_each() -> void:
		_world = autofree(Scene.make_world())
		_device = _world.device
		_device.geometry = HapticPantographGeometry.create(Geometry.Preset.UBC_TWIN_PANTOGRAPH)
		_device.inertia_model = HapticSimulatedPantograph.InertiaModel.LINKAGE
		_device.encoder_model = HapticSimulatedPantograph.EncoderModel.JOINT
		_device.compensation = HapticCompensation.new()

	func _problems() -> PackedStringArray:
		add_child_autofree(Scene.gather([_world, Scene.make_tool()]))
		await wait_physics_frames(1)
		return Checks.of_world(_world)

	func test_friction_without_figures_is_named() -> void:
		_device.compensation.friction_share = 0.5
		var problems: PackedStringArray = await _problems()
		assert_push_error("compensation.friction_share is 0.5")
		assert_eq(problems.size(), 1)
		assert_string_contains(problems[0], "The geometry has no friction figures")

	func test_shares_beyond_what_is_passive_are_named() -> void:
		_device.geometry.coulomb_friction = 0.005
		_device.compensation.friction_share = 0.8
		_device.compensation.inertia_share = 0.6
		var problems: PackedStringArray = await _problems()
		assert_push_error_count(2)
		var limits := "compensation.%s is %s, must lie between 0 and %s"
		assert_string_contains(problems[0], limits % ["friction_share", 0.8, 0.7])
		assert_string_contains(problems[1], limits % ["inertia_share", 0.6, 0.5])

	func test_a_constant_handle_has_nothing_to_compensate() -> void:
		_device.inertia_model = HapticSimulatedPantograph.InertiaModel.CONSTANT
		_device.compensation.gravity = Vector2(0, 9.81)
		var problems: PackedStringArray = await _problems()
		assert_push_error("device.inertia_model is constant")
		assert_eq(problems.size(), 1)

	func test_an_upright_device_is_held() -> void:
		_device.geometry.viscous_friction = 0.001
		_device.geometry.coulomb_friction = 0.002
		_device.gravity = Vector2(0, 9.81)
		_device.compensation.gravity = Vector2(0, 9.81)
		_device.hand = Scene.make_path([[0.0, 0.0, 0.0, 0.0], [60.0, 0.0, 0.0, 0.0]])
		_device.hand_unattended = null
		var problems: PackedStringArray = await _problems()
		assert_eq(problems, PackedStringArray())
		await wait_physics_frames(120)
		assert_true(_world.is_armed())
		# the motors hold what the links and the handle weigh
		assert_gt(-_world.get_force().y, 1.0)
		assert_almost_eq(_world.get_handle().origin, Vector2.ZERO, Vector2(4.0, 4.0))
