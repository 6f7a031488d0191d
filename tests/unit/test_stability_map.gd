extends GutTest
## The stability maps that the editor carries.

const StabilityMap := preload("res://addons/haptics/editor/stability_map.gd")
const SEMI := HapticWorld2D.Integrator.SEMI_IMPLICIT
const IMPLICIT := HapticWorld2D.Integrator.LINEARLY_IMPLICIT


func test_between_points_the_worse_side_counts_and_outside_nothing_is_promised() -> void:
	var file := OS.get_user_data_dir().path_join("map.json")
	var text := FileAccess.open(file, FileAccess.WRITE)
	var rows: Array[Dictionary] = []
	for point: Array in [
		[500.0, 0.1, 3e4], [500.0, 1.0, 3e5], [1000.0, 0.1, 1e5], [1000.0, 1.0, 1e6]
	]:
		rows.append(
			{
				"integrator": "semi_implicit",
				"rate_hz": point[0],
				"mass_kg": point[1],
				"stiffest_n_per_m": point[2]
			}
		)
	var device := {
		"coupling": "direct",
		"rate_hz": 500.0,
		"delay_steps": 2,
		"encoder_m": 1e-5,
		"stiffest_n_per_m": 300.0
	}
	text.store_string(JSON.stringify({"proxy": rows, "device": [device]}))
	text.close()
	var map := StabilityMap.new(file)
	assert_eq(map.stiffest_wall(SEMI, 500.0, 1.0), 3e5)
	assert_eq(map.stiffest_wall(SEMI, 999.0, 0.5), 3e4)
	assert_eq(map.stiffest_wall(SEMI, 2000.0, 0.5), 1e5)
	assert_eq(map.stiffest_wall(SEMI, 499.0, 1.0), 0.0)
	assert_eq(map.stiffest_wall(SEMI, 500.0, 0.05), 0.0)
	assert_eq(map.stiffest_wall(SEMI, 500.0, 2.0), 0.0)
	assert_eq(map.stiffest_wall(IMPLICIT, 500.0, 1.0), 0.0)
	var direct := HapticWorld2D.Coupling.DIRECT
	assert_eq(map.stiffest_wall_through_device(direct, 600.0, 1, 1e-6), 300.0)
	assert_eq(map.stiffest_wall_through_device(direct, 600.0, 3, 1e-6), 0.0)
	assert_eq(map.stiffest_wall_through_device(direct, 600.0, 2, 1e-4), 0.0)


func test_the_maps_that_ship_agree_with_the_bound_of_semi_implicit_steps() -> void:
	var map := StabilityMap.new()
	for rate: float in [500.0, 1000.0, 4000.0]:
		for mass: float in [0.1, 0.3, 1.0]:
			var step := 1.0 / rate
			# K T² + 2 B T = 4 m
			var bound := (4.0 * mass - 2.0 * 20.0 * step) / (step * step)
			var seen := map.stiffest_wall(SEMI, rate, mass)
			assert_between(seen, 15000.0, bound, "%s Hz, %s kg" % [rate, mass])
			assert_gte(map.stiffest_wall(IMPLICIT, rate, mass), 1e8)
	var far := map.stiffest_wall_through_device(HapticWorld2D.Coupling.FOUR_CHANNEL, 500.0, 1, 1e-6)
	var near := map.stiffest_wall_through_device(HapticWorld2D.Coupling.DIRECT, 500.0, 1, 1e-6)
	assert_gte(far, 40.0 * near)
	assert_gt(near, 0.0)


func test_a_map_that_is_not_there_is_said_and_promises_nothing() -> void:
	var map := StabilityMap.new("res://no_such_map.json")
	assert_push_error("no stability map")
	assert_eq(map.stiffest_wall(SEMI, 1000.0, 0.3), 0.0)
