extends GutTest
## What the tool pushes is Godot's: it rubs on what Godot lets it rub on, falls as it falls there,
## and meets what its own mask selects.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Rows := preload("res://tests/support/run_rows.gd")

# px/s²
const GRAVITY := 980.0

var _world: HapticWorld2D
var _object: HapticObject2D


func before_all() -> void:
	Scene.hurry()


func before_each() -> void:
	_set_gravity(GRAVITY)


func after_each() -> void:
	_set_gravity(0.0)


func after_all() -> void:
	Scene.calm_down()


func _set_gravity(strength: float) -> void:
	PhysicsServer2D.area_set_param(
		get_viewport().find_world_2d().space, PhysicsServer2D.AREA_PARAM_GRAVITY, strength
	)


# along a floor with the friction of PhysicsMaterials; surfaces are rough for the tool alone
func test_pushing_an_object_along_a_floor_takes_mu_m_g(
	friction: float = use_parameters([0.2, 0.5, 1.0])
) -> void:
	_world = Scene.make_world()
	_world.record_seconds = 3.0
	var hand := Scene.make_path([[0.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.0, 0.0], [2.1, 0.06, 0.0, 0.0]])
	hand.smooth = false
	(_world.device as HapticSimulatedPantograph).hand = hand
	_object = Scene.make_object(Vector2(90, 20), Vector2(80, 40), 0.5)
	_object.gravity_scale = 1.0
	_object.surface.static_friction = 0.7
	_object.surface.dynamic_friction = 0.7
	_object.physics_material_override = PhysicsMaterial.new()
	_object.physics_material_override.friction = friction
	var ground := Scene.make_wall(Vector2(0, 60), Vector2(4000, 40))
	ground.surface.static_friction = 0.7
	ground.surface.dynamic_friction = 0.7
	var tool := Scene.make_tool(Vector2(0, 15), Vector2(80, 40))
	tool.surface = HapticSurface.new()
	add_child_autofree(Scene.gather([_world, tool, _object, ground]))
	await wait_physics_frames(126)
	var rows: Rows = Rows.of(_world)
	var force := -rows.mean("contact_force_x_n", 1.3, 2.0) - rows.mean("impulse_x_n", 1.3, 2.0)
	var wanted := friction * 0.5 * GRAVITY / 4000.0
	assert_almost_eq(force, wanted, 0.02 * wanted)
	# no taps at the ticks
	assert_lt(rows.largest_force(1.3, 2.0) - rows.smallest_force(1.3, 2.0), 0.05)
	assert_eq(_world.get_faults(), PackedStringArray())


func test_a_body_falls_as_godot_lets_it(share: float = use_parameters([1.0, 0.5, 0.0])) -> void:
	_world = Scene.make_world()
	_world.gravity_source = HapticWorld2D.GravitySource.PROJECT
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(
		[[0.0, 0.0, 0.0, 0.0], [5.0, 0.0, 0.0, 0.0]]
	)
	var tool := Scene.make_tool(Vector2.ZERO, Vector2(160, 40))
	_object = Scene.make_object(Vector2(0, -41), Vector2(40, 40), 0.1)
	_object.gravity_scale = 0.0
	if share > 0.0:
		# half of it by a force, as an engine or a wind would
		_object.gravity_scale = share - 0.25
		_object.constant_force = Vector2(0, 0.25 * 0.1 * GRAVITY)
	add_child_autofree(Scene.gather([_world, tool, _object]))
	await wait_physics_frames(90)
	assert_almost_eq(_world.get_contact_force().y, share * 0.1 * GRAVITY / 4000.0, 2e-4)
	assert_almost_eq(_object.position.y, tool.position.y - 40.0, 1.5)
	assert_almost_eq(_object.linear_velocity.y, 0.0, 1.0)


# the floor is on layer 2
func test_what_is_pushed_meets_what_its_own_mask_selects(
	masks: Array = use_parameters([[1, 1, false], [1, 2, true], [3, 1, false], [3, 3, true]])
) -> void:
	_set_gravity(0.0)
	_world = Scene.make_world(Vector2(0, 1.0), 0.3)
	var tool := Scene.make_tool(Vector2(0, -22), Vector2(80, 40))
	tool.collision_mask = masks[0]
	_object = Scene.make_object(Vector2(0, 20), Vector2(80, 40), 0.5)
	_object.collision_mask = masks[1]
	var ground := Scene.make_wall(Vector2(0, 61), Vector2(4000, 40))
	ground.collision_layer = 2
	add_child_autofree(Scene.gather([_world, tool, _object, ground]))
	await wait_physics_frames(60)
	if masks[2] as bool:
		assert_almost_eq(_object.position.y, 21.0, 0.5)
		assert_almost_eq(_world.get_force().y, -1.0, 0.05)
	else:
		assert_gt(_object.position.y, 100.0)
