@tool
extends "fixed_body.gd"
## The cells of a TileMapLayer that share a surface, at most one square of cells.
##
## Godot merges the cells of 16 x 16 into one body, and its shapes tell neither the surface nor the
## side they let pass: what is felt is read from the tiles.

# numbers of shapes in a cell: physics layers and polygons of each
const _PER_LAYER := 16
const _PER_CELL := 16 * _PER_LAYER

## First cell of the square, and cells that have this surface.
var first_cell: Vector2i
var cells: Array[Vector2i] = []
## Physics layers of the tile set that the tool touches, bit by bit.
var physics_layers := 0
## Surface of these cells; null is the world's.
var cell_surface: HapticSurface


func surface(fallback: HapticSurface) -> HapticSurface:
	if cell_surface != null:
		return cell_surface
	return super.surface(fallback)


func _features() -> Array:
	return [kind(), scaling(), _layer(), _friction()]


# of all physics layers that are read
func _layer() -> int:
	var tiles := (node as TileMapLayer).tile_set
	var bits := 0
	for index: int in tiles.get_physics_layers_count():
		if physics_layers & (1 << index) != 0:
			bits |= tiles.get_physics_layer_collision_layer(index)
	return bits


# of the first physics layer that is read
func _friction() -> float:
	var tiles := (node as TileMapLayer).tile_set
	for index: int in tiles.get_physics_layers_count():
		if physics_layers & (1 << index) == 0:
			continue
		var material := tiles.get_physics_layer_physics_material(index)
		if material != null:
			return -material.friction if material.rough else material.friction
		break
	return 1.0


func _read_shapes(reader: ShapeReader) -> void:
	var layer := node as TileMapLayer
	var place := scaling()
	for cell: Vector2i in cells:
		var data := layer.get_cell_tile_data(cell)
		if data == null:
			continue
		var at := place.translated_local(layer.map_to_local(cell))
		var local := cell - first_cell
		var first_id := (local.y * 8 + local.x) * _PER_CELL + 1
		for index: int in layer.tile_set.get_physics_layers_count():
			if physics_layers & (1 << index) == 0:
				continue
			for polygon: int in data.get_collision_polygons_count(index):
				reader.add_outline(
					first_id + index * _PER_LAYER + polygon,
					_turned(layer, cell, data.get_collision_polygon_points(index, polygon)),
					at,
					data.is_collision_polygon_one_way(index, polygon)
				)


# as the engine turns the polygons of a cell that is flipped or transposed
func _turned(layer: TileMapLayer, cell: Vector2i, points: PackedVector2Array) -> PackedVector2Array:
	var turn := Transform2D.IDENTITY
	if layer.is_cell_transposed(cell):
		turn = Transform2D(Vector2(0, 1), Vector2(1, 0), Vector2.ZERO)
	if layer.is_cell_flipped_h(cell):
		turn = Transform2D(Vector2(-1, 0), Vector2(0, 1), Vector2.ZERO) * turn
	if layer.is_cell_flipped_v(cell):
		turn = Transform2D(Vector2(1, 0), Vector2(0, -1), Vector2.ZERO) * turn
	return turn * points
