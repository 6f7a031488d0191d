@tool
extends RefCounted
## How far from the tool something may matter before the next look around.
##
## The tool has to be met by whatever it can run into until the next snapshot counts. That takes the
## time to the next tick, one tick more in case that one comes late, and the latency of the loop: t.
## From speed v it gets faster with the acceleration a of a strong hand, up to the speed that the
## output gate allows, and its farthest point is one extent away from its origin. Ticks are bunched
## when frames are slow, so the longest pause between two looks of the last second counts, not the
## length of a tick.

## Looked around in any case, m.
const MARGIN := 0.01

# m/s²: what a desktop device gives a light handle (8 N on 0.25 kg)
const _ACCELERATION := 32.0
# nothing in a scene is faster, m/s
const _FASTEST := 1000.0
# report to the scene, snapshot to the loop: a haptic step each, s
const _LATENCY := 0.002
# a longer pause fades the force out; there is no use in looking farther, s
const _LONGEST_PAUSE := 0.25
# share of the longest pause that is left after a second
const _LEFT_AFTER_SECOND := 0.1

var _pause := 0.0
var _last_look := -1.0


## Notes a look around at `now` (s, any clock): the pause since the last one may come again.
func note(now: float) -> void:
	if _last_look >= 0.0:
		var since := maxf(now - _last_look, 0.0)
		_pause = maxf(minf(since, _LONGEST_PAUSE), _pause * pow(_LEFT_AFTER_SECOND, since))
	_last_look = now


## Reach from the tool's origin, m: `extent` of the tool, `speed` of its origin and the highest that
## it may have (m/s), `tick` (s of real time).
func distance(extent: float, speed: float, top_speed: float, tick: float) -> float:
	# a center of mass that is nowhere makes no speed
	if not speed < _FASTEST:
		speed = top_speed
	var time := maxf(tick, _pause) + tick + _LATENCY
	var rise := clampf((top_speed - speed) / _ACCELERATION, 0.0, time)
	var way := speed * time + _ACCELERATION * rise * (time - 0.5 * rise)
	return extent + way + MARGIN
