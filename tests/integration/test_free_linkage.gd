extends GutTest
## A linkage that nobody holds moves by itself, against closed forms, and meets the held tool.

const Scene := preload("res://tests/support/haptic_scene.gd")
const Linkages := preload("res://tests/support/linkages.gd")
const FreeLinkage := preload("res://addons/haptics/nodes/free_linkage.gd")

const _TICK := 1.0 / 60.0
const _G := 9.81
# a link of make_link(200 x 20 px) with 0.1 kg, in SI
const _MASS := 0.1
const _LENGTH := 0.05
const _WIDTH := 0.005
const _CENTER := 0.025

var _world: HapticWorld2D
var _linkage: HapticLinkage2D


func before_all() -> void:
	Scene.hurry()


func after_all() -> void:
	Scene.calm_down()


func before_each() -> void:
	_world = Scene.make_world()


# the tool, far away unless said otherwise
func _run(more: Array[Node], ticks: int, tool: HapticTool2D = null) -> void:
	if tool == null:
		tool = Scene.make_tool(Vector2(0, 2000), Vector2(60, 60))
	var nodes: Array[Node] = [_world, _linkage, tool]
	add_child_autofree(Scene.gather(nodes + more))
	await wait_physics_frames(ticks)


# a hand that pushes from the start time on
func _push_with(force: Vector2, start_time: float) -> void:
	_world.free()
	_world = Scene.make_world(force, start_time)


func _with_gravity() -> void:
	_world.gravity_source = HapticWorld2D.GravitySource.CUSTOM
	_world.gravity = Vector2(0.0, _G)


func _inertia_at_center() -> float:
	return _MASS * (_LENGTH * _LENGTH + _WIDTH * _WIDTH) / 12.0


# of all links, SI: kinetic energy and the one of height
func _energy() -> float:
	var mover := _linkage.get_mover()
	var energy := 0.0
	for link: HapticLink2D in _linkage.get_links():
		var state := mover.state_of(link)
		var size := Linkages.size_of(link) / _world.pixels_per_meter
		var inertia := link.mass * size.length_squared() / 12.0
		var speed := Vector2(state[3], state[4])
		energy += 0.5 * link.mass * speed.length_squared() + 0.5 * inertia * state[5] * state[5]
		var center := link.to_global(link.center_of_mass)
		energy -= link.mass * _G * center.y / _world.pixels_per_meter
	return energy


func test_a_pendulum_swings_with_its_period() -> void:
	_with_gravity()
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	var link := _linkage.get_links()[0]
	var swing := 0.1
	link.rotation = PI / 2.0 + swing
	await _run([], 5)
	var at := -1.0
	var first := -1.0
	var crossings := 0
	var last := link.rotation - PI / 2.0
	for i: int in 400:
		await get_tree().physics_frame
		var now := link.rotation - PI / 2.0
		if last > 0.0 and now <= 0.0:
			at = (float(i) + last / (last - now)) * _TICK
			if first < 0.0:
				first = at
			else:
				crossings += 1
		last = now
	var inertia := _inertia_at_center() + _MASS * _CENTER * _CENTER
	var period := TAU * sqrt(inertia / (_MASS * _G * _CENTER)) * (1.0 + swing * swing / 16.0)
	assert_gt(crossings, 10)
	assert_almost_eq((at - first) / crossings, period, 0.002 * period)


func test_a_free_arm_keeps_its_energy() -> void:
	_with_gravity()
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	_linkage.get_links()[0].rotation = 0.6
	await _run([], 3)
	var start := _energy()
	# from stretched out to hanging, at the links' masses
	var scale := 0.3 * _G * 0.0375
	var most := 0.0
	for i: int in 300:
		await get_tree().physics_frame
		most = maxf(most, absf(_energy() - start))
	assert_lt(most, 0.03 * scale)
	assert_gt(most, 0.0)
	gut.p("energy of a free arm wanders by %.2f %% of its swing" % (100.0 * most / scale))


func test_what_floats_goes_on_by_itself() -> void:
	_linkage = Linkages.make_chain(2, Vector2(100, 20))
	_linkage.grounded = false
	await _run([], 5)
	var before := _linkage.get_links()[0].global_position
	await wait_physics_frames(30)
	assert_almost_eq(_linkage.get_links()[0].global_position, before, Vector2(1e-3, 1e-3))


# a tool that pushes with `force` (N) on the free end of a door, whose joint has the given figures
func _push_door(force: float, set_up: Callable, ticks: int) -> HapticTool2D:
	_push_with(Vector2(0.0, force), 0.3)
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	set_up.call(_linkage.get_links()[0])
	var tool := Scene.make_tool(Vector2(160, -22), Vector2(40, 20))
	# or it slides off when the door yields
	tool.surface = Linkages.make_rough()
	_linkage.get_links()[0].surface = Linkages.make_rough()
	await _run([], ticks, tool)
	return tool


func test_a_door_with_a_spring_gives_way_by_the_moment_of_the_push() -> void:
	var tool := await _push_door(
		1.0,
		func(link: HapticLink2D) -> void:
			link.spring_stiffness = 0.4
			link.joint_damping = 0.002,
		400
	)
	var door := _linkage.get_links()[0]
	assert_true(tool.is_touching(door))
	assert_false(_linkage.is_tool())
	assert_almost_eq(tool.get_force_from(door), Vector2(0.0, -1.0), Vector2(0.02, 0.02))
	# moment of the push about the hinge
	var moment := 0.0
	for contact: HapticContact in tool.get_contacts_with(door):
		moment -= contact.position.cross(contact.force) / 4000.0
	assert_gt(moment, 0.03)
	assert_almost_eq(door.get_coordinate(), moment / 0.4, 0.02 * moment / 0.4)
	assert_lt(_world.get_speed(), 0.001)


func test_a_push_against_a_stop_is_felt_as_it_is_applied_and_still() -> void:
	var tool := await _push_door(
		2.0,
		func(link: HapticLink2D) -> void:
			link.has_limits = true
			link.lower_limit = -0.1
			link.upper_limit = 0.1,
		300
	)
	var door := _linkage.get_links()[0]
	var least := INF
	var most := -INF
	for i: int in 120:
		await get_tree().physics_frame
		var felt := tool.get_force_from(door).length()
		least = minf(least, felt)
		most = maxf(most, felt)
	assert_almost_eq(0.5 * (least + most), 2.0, 0.05)
	assert_lt(most - least, 0.05)
	assert_almost_eq(door.get_coordinate(), 0.1, 0.005)
	gut.p("push of 2 N on a stop: felt %.4f to %.4f N" % [least, most])


func test_tool_and_linkage_go_on_as_one_mass() -> void:
	_push_with(Vector2(0.06, 0.0), 0.3)
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	_linkage.grounded = false
	var link := _linkage.get_links()[0]
	# pushed along its axis through the center of mass, from behind
	var tool := Linkages.make_ball(Vector2(-22, 0), 20.0)
	# once they have met
	await _run([], 50, tool)
	var given := 0.0
	var felt := 0.0
	var before := _linkage.get_mover().state_of(link)[3]
	for i: int in 30:
		await get_tree().physics_frame
		felt -= tool.get_force_from(link).x * _TICK
	given = _MASS * (_linkage.get_mover().state_of(link)[3] - before)
	assert_gt(given, 0.002)
	assert_almost_eq(felt, given, 0.05 * given)
	# both at one speed
	assert_almost_eq(
		_linkage.get_mover().state_of(link)[3], _world.get_speed(), 0.03 * _world.get_speed()
	)
	gut.p("momentum: felt %.5f N s, given %.5f N s" % [felt, given])


func test_a_pushed_arm_that_leans_on_a_wall_does_not_give_way() -> void:
	_push_with(Vector2(0.0, 1.0), 0.3)
	_linkage = Linkages.make_chain(3, Vector2(100, 20))
	for link: HapticLink2D in _linkage.get_links():
		link.joint_damping = 0.0005
		link.joint_friction = 0.001
	var tool := Linkages.make_ball(Vector2(85, -32), 20.0)
	var more: Array[Node] = [Scene.make_wall(Vector2(170, 190), Vector2(400, 40))]
	await _run(more, 600, tool)
	var least := INF
	var most := -INF
	for i: int in 60:
		await get_tree().physics_frame
		var felt := (
			-tool.get_contacts().reduce(
				func(sum: float, c: HapticContact) -> float: return sum + c.force.y, 0.0
			)
			as float
		)
		least = minf(least, felt)
		most = maxf(most, felt)
	gut.p("arm on a wall: felt %.3f to %.3f N" % [least, most])
	assert_almost_eq(0.5 * (least + most), 1.0, 0.05)
	assert_lt(most - least, 0.1)
	assert_lt(_world.get_penetration(), 0.0005)


func test_a_linkage_that_is_left_goes_on_with_its_speed() -> void:
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	var path: Array[PackedFloat64Array] = [
		[0.0, 0.0, 0.0, 0.0], [0.4, 0.0, 0.0, 0.0], [1.4, 0.0, 0.03, 0.0]
	]
	(_world.device as HapticSimulatedPantograph).hand = Scene.make_path(path)
	_linkage.start_link = _linkage.get_links()[0]
	var tool := Scene.make_tool(Vector2(0, 2000), Vector2(60, 60))
	var nodes: Array[Node] = [_world, _linkage, tool]
	_world.auto_start = false
	add_child_autofree(Scene.gather(nodes))
	await wait_physics_frames(1)
	_world.take(_linkage.get_links()[0])
	await wait_physics_frames(50)
	var link := _linkage.get_links()[0]
	var rate := _linkage.get_rate(link)
	assert_gt(rate, 0.3)
	_world.take(tool)
	await wait_physics_frames(2)
	assert_false(_linkage.is_tool())
	assert_almost_eq(_linkage.get_rate(link), rate, 0.02 * rate)


func test_it_follows_its_node_and_its_figures() -> void:
	_with_gravity()
	_linkage = Linkages.make_chain(1, Vector2(200, 20))
	await _run([], 10)
	_linkage.position = Vector2(50, -30)
	await wait_physics_frames(2)
	assert_almost_eq(_linkage.get_links()[0].global_position, Vector2(50, -30), Vector2(0.01, 0.01))
	var link := _linkage.get_links()[0]
	link.spring_stiffness = 5.0
	link.spring_rest = 0.3
	link.joint_damping = 0.01
	await wait_physics_frames(240)
	var sag := _MASS * _G * _CENTER * cos(link.rotation) / 5.0
	assert_almost_eq(link.get_coordinate(), 0.3 + sag, 0.002)


# Two equal pendulums side by side that touch when both hang; `first` is lifted by 0.6 rad and
# swings against `second`. Returns how far each gets after the hit, and how much the energy grew.
func _cradle(restitution: float, swapped: bool, world_runs: bool = true) -> Dictionary:
	_with_gravity()
	_world.auto_start = world_runs
	var surface := HapticSurface.new()
	surface.restitution = restitution
	surface.static_friction = 0.0
	surface.dynamic_friction = 0.0
	_world.default_surface = surface
	var first := Linkages.make_chain(1, Vector2(200, 20))
	var second := Linkages.make_chain(1, Vector2(200, 20), Vector2(-20.2, 0))
	# the screen's y points down: less than a right angle is to the right
	first.get_links()[0].rotation = PI / 2.0 - 0.6
	second.get_links()[0].rotation = PI / 2.0
	_linkage = second if swapped else first
	await _run([first if swapped else second], 1)
	var start := 0.0
	var most := -INF
	var farthest: Array[float] = [0.0, 0.0]
	# a quarter of a period is 6 ticks: the way down, up again, and not until the next hit
	for i: int in 13:
		await get_tree().physics_frame
		var sum := 0.0
		for one: HapticLinkage2D in [first, second]:
			_linkage = one
			sum += _energy() if one.get_mover() != null else 0.0
		if i == 1:
			start = sum
		most = maxf(most, sum - start)
		if i > 4:
			farthest[0] = maxf(farthest[0], first.get_links()[0].rotation - PI / 2.0)
			farthest[1] = maxf(farthest[1], second.get_links()[0].rotation - PI / 2.0)
	return {"first": farthest[0], "second": farthest[1], "gain": most}


# equal masses without loss: the one that came stays, the other goes on as far
func _check_cradle(swapped: bool, world_runs: bool = true) -> void:
	var cradle := await _cradle(1.0, swapped, world_runs)
	assert_eq(_world.is_running(), world_runs)
	assert_almost_eq(cradle["second"] as float, 0.6, 0.03)
	assert_almost_eq(cradle["first"] as float, 0.0, 0.06)
	assert_lt(cradle["gain"] as float, 2e-4)


# a door at its upper stop, its copy and one that was saved and loaded: stops are where they were
func test_a_copy_of_a_linkage_that_has_moved_keeps_its_joints() -> void:
	_with_gravity()
	_linkage = Linkages.make_chain(2, Vector2(200, 20))
	var door := _linkage.get_links()[0]
	door.has_limits = true
	door.upper_limit = 0.4
	door.limit_damping = 0.1
	_linkage.get_links()[1].joint = HapticLink2D.Joint.FIXED
	await _run([], 90)
	assert_almost_eq(door.get_coordinate(), 0.4, 0.01)
	var scene := PackedScene.new()
	for node: Node in _linkage.find_children("*", "", true, false):
		node.owner = _linkage
	assert_eq(scene.pack(_linkage), OK)
	var copies: Array[HapticLinkage2D] = [
		_linkage.duplicate() as HapticLinkage2D, scene.instantiate() as HapticLinkage2D
	]
	# one that is put elsewhere begins there
	var turned := _linkage.duplicate() as HapticLinkage2D
	turned.get_links()[0].rotation -= 0.5
	copies.append(turned)
	for i: int in copies.size():
		copies[i].position.x += 800.0 * (i + 1)
		_linkage.get_parent().add_child(copies[i])
	await wait_physics_frames(90)
	for i: int in 2:
		assert_almost_eq(copies[i].get_links()[0].get_coordinate(), 0.4, 0.01)
		assert_almost_eq(copies[i].get_links()[0].rotation, door.rotation, 0.01)
	assert_almost_eq(turned.get_links()[0].rotation, door.rotation - 0.1, 0.02)


func test_two_pendulums_hand_a_swing_over() -> void:
	await _check_cradle(false)


func test_two_pendulums_hand_a_swing_over_whichever_started_first() -> void:
	await _check_cradle(true)


func test_two_pendulums_hand_a_swing_over_while_no_world_runs() -> void:
	await _check_cradle(false, false)
	# the world starts: both go on beside its tool
	assert_true(_world.start())
	await wait_physics_frames(3)
	for linkage: Node in get_tree().get_nodes_in_group(&"haptic_linkages"):
		assert_true((linkage as HapticLinkage2D).get_mover().is_beside_tool())
	_world.stop()
	await wait_physics_frames(3)
	assert_not_null(_linkage.get_mover())


func test_two_pendulums_go_on_together_where_nothing_bounces() -> void:
	# at the hit both get half the rate, a quarter of the height in all
	var cradle := await _cradle(0.0, false)
	var angle := acos(1.0 - 0.25 * (1.0 - cos(0.6)))
	assert_almost_eq(cradle["first"] as float, angle, 0.03)
	assert_almost_eq(cradle["second"] as float, angle, 0.03)
	assert_lt(cradle["gain"] as float, 2e-4)


func test_one_that_ran_away_is_told_once() -> void:
	_world.gravity_source = HapticWorld2D.GravitySource.CUSTOM
	_world.gravity = Vector2(0.0, 3.0e8)
	_linkage = Linkages.make_chain(2, Vector2(200, 20))
	_linkage.grounded = false
	await _run([], 12)
	assert_push_warning("ran away (beyond 1000 km or 1000 km/s")
	assert_push_warning_count(1)
