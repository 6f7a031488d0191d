extends RefCounted
## Tile maps built in code.

## Tiles of a tile set made by make_set(): whole, half (its lower half), one-way, and one with a
## surface of its own in the custom data layer haptic_surface.
const WHOLE := Vector2i(0, 0)
const HALF := Vector2i(1, 0)
const ONE_WAY := Vector2i(2, 0)
const OWN_SURFACE := Vector2i(3, 0)

## Side of a tile, px.
const SIZE := 20


## A tile set on physics layer `layer_bits`; `own` is the surface of OWN_SURFACE.
static func make_set(own: HapticSurface = null, layer_bits: int = 1) -> TileSet:
	var tiles := TileSet.new()
	tiles.tile_size = Vector2i(SIZE, SIZE)
	tiles.add_physics_layer()
	tiles.set_physics_layer_collision_layer(0, layer_bits)
	tiles.add_custom_data_layer()
	tiles.set_custom_data_layer_name(0, "haptic_surface")
	tiles.set_custom_data_layer_type(0, TYPE_OBJECT)
	var source := TileSetAtlasSource.new()
	var texture := PlaceholderTexture2D.new()
	texture.size = Vector2(4 * SIZE, SIZE)
	source.texture = texture
	source.texture_region_size = tiles.tile_size
	tiles.add_source(source)
	var half := SIZE / 2.0
	for at: Vector2i in [WHOLE, HALF, ONE_WAY, OWN_SURFACE]:
		source.create_tile(at)
		var data := source.get_tile_data(at, 0)
		data.add_collision_polygon(0)
		var top := 0.0 if at == HALF else -half
		data.set_collision_polygon_points(
			0,
			0,
			[Vector2(-half, top), Vector2(half, top), Vector2(half, half), Vector2(-half, half)]
		)
		data.set_collision_polygon_one_way(0, 0, at == ONE_WAY)
	source.get_tile_data(OWN_SURFACE, 0).set_custom_data("haptic_surface", own)
	return tiles


## A layer of `tiles` with these cells, all of the same tile.
static func make_layer(
	tiles: TileSet, cells: Rect2i, tile: Vector2i = WHOLE, alternative: int = 0
) -> TileMapLayer:
	var layer := TileMapLayer.new()
	layer.name = "Tiles"
	layer.tile_set = tiles
	for y: int in range(cells.position.y, cells.end.y):
		for x: int in range(cells.position.x, cells.end.x):
			layer.set_cell(Vector2i(x, y), 0, tile, alternative)
	return layer
