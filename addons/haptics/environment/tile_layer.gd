@tool
extends RefCounted
## Reads a TileMapLayer square by square of cells, as far as the tool gets near.

const BodyReader := preload("body_reader.gd")
const TileBody := preload("tile_body.gd")
const SurfaceReader := preload("surface_reader.gd")

## Cells along the side of a square; numbers of shapes in tile_body.gd rely on it.
const SQUARE := 8
# cells that were set or erased at run time have no signal: every square near is compared in so many
# looks
const _LOOKS_TO_COMPARE := 8
# most looks along one axis when the cells in a region are found
const _MOST_LOOKS := 64

## The layer.
var node: TileMapLayer

var _squares: Dictionary[Vector2i, Array] = {}
var _mask := 0
var _is_stale := false
# what the cells of a square were when they were read
var _prints: Dictionary[Vector2i, int] = {}
var _look := 0


func _init(layer: TileMapLayer) -> void:
	node = layer
	layer.changed.connect(_on_changed)


## The bodies of the squares within `radius` px of `center` (canvas) that `mask` selects. `adopt`
## gives a new TileBody its number: (TileMapLayer) -> TileBody; `drop` takes one back.
func find_near(
	center: Vector2, radius: float, mask: int, adopt: Callable, drop: Callable
) -> Array[BodyReader]:
	var found: Array[BodyReader] = []
	if node.tile_set == null:
		return found
	if _is_stale or mask != _mask:
		_mask = mask
		_is_stale = false
		_read_again(adopt, drop)
	_look += 1
	var turn := _look
	for square: Vector2i in _squares_near(center, radius):
		turn += 1
		if not _squares.has(square):
			_squares[square] = []
			_read(square, adopt, drop)
		elif turn % _LOOKS_TO_COMPARE == 0 and _print_of(square) != _prints[square]:
			_read(square, adopt, drop)
		for body: TileBody in _squares[square]:
			found.append(body)
	return found


## Every body made for this layer.
func bodies() -> Array[TileBody]:
	var all: Array[TileBody] = []
	for square: Vector2i in _squares:
		for body: TileBody in _squares[square]:
			all.append(body)
	return all


func _on_changed() -> void:
	_is_stale = true


func _read_again(adopt: Callable, drop: Callable) -> void:
	for square: Vector2i in _squares:
		_read(square, adopt, drop)


# sorts the cells of a square by their surface
func _read(square: Vector2i, adopt: Callable, drop: Callable) -> void:
	_prints[square] = _print_of(square)
	var layers := 0
	for index: int in mini(node.tile_set.get_physics_layers_count(), 16):
		if node.tile_set.get_physics_layer_collision_layer(index) & _mask != 0:
			layers |= 1 << index
	var data_layer := node.tile_set.get_custom_data_layer_by_name(SurfaceReader.NAME)
	var groups: Dictionary[HapticSurface, Array] = {}
	for y: int in SQUARE:
		for x: int in SQUARE:
			var cell := square * SQUARE + Vector2i(x, y)
			var data := node.get_cell_tile_data(cell)
			if data == null or not _collides(data, layers):
				continue
			var own: HapticSurface = null
			if data_layer >= 0:
				own = data.get_custom_data_by_layer_id(data_layer) as HapticSurface
			if not groups.has(own):
				groups[own] = []
			groups[own].append(cell)
	var kept: Array = []
	for body: TileBody in _squares[square]:
		# a surface keeps its body, so that what is being touched goes on
		if groups.has(body.cell_surface):
			kept.append(body)
		else:
			drop.call(body)
	for own: HapticSurface in groups:
		var body := _body_with(kept, own)
		if body == null:
			body = adopt.call(node) as TileBody
			body.cell_surface = own
			body.first_cell = square * SQUARE
			kept.append(body)
		body.cells.assign(groups[own])
		body.physics_layers = layers
		body.is_dirty = true
	_squares[square] = kept


func _print_of(square: Vector2i) -> int:
	var marks := PackedInt32Array()
	for y: int in SQUARE:
		for x: int in SQUARE:
			var cell := square * SQUARE + Vector2i(x, y)
			var source := node.get_cell_source_id(cell)
			marks.append(source)
			if source >= 0:
				var at := node.get_cell_atlas_coords(cell)
				marks.append(at.x)
				marks.append(at.y)
				marks.append(node.get_cell_alternative_tile(cell))
	return hash(marks)


func _body_with(bodies_there: Array, own: HapticSurface) -> TileBody:
	for body: TileBody in bodies_there:
		if body.cell_surface == own:
			return body
	return null


func _collides(data: TileData, layers: int) -> bool:
	for index: int in 16:
		if layers & (1 << index) != 0 and data.get_collision_polygons_count(index) > 0:
			return true
	return false


# squares that hold cells of the region; a tile's polygon may reach out of its cell by about one
# cell
func _squares_near(center: Vector2, radius: float) -> Array[Vector2i]:
	var tile := Vector2(node.tile_set.tile_size)
	var bounds := (
		node.global_transform.affine_inverse()
		* Rect2(center - Vector2(radius, radius), Vector2(2.0, 2.0) * radius)
	)
	bounds = bounds.grow_individual(tile.x, tile.y, tile.x, tile.y)
	# of a square grid the corners tell all; other grids are looked at every half cell
	var pitch := tile * 0.5
	if node.tile_set.tile_shape == TileSet.TILE_SHAPE_SQUARE:
		pitch = tile * SQUARE
	var looks := Vector2i((bounds.size / pitch).ceil()).clampi(1, _MOST_LOOKS)
	var found: Dictionary[Vector2i, bool] = {}
	for y: int in looks.y + 1:
		for x: int in looks.x + 1:
			var at := bounds.position + bounds.size * Vector2(x, y) / Vector2(looks)
			var cell := node.local_to_map(at)
			found[Vector2i((Vector2(cell) / SQUARE).floor())] = true
	return found.keys()
