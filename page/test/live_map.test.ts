import assert from "node:assert/strict";
import { test } from "node:test";
import { BufferAttribute, BufferGeometry, MeshBVH } from "../src/three";
import { STATES } from "../src/codes.ts";
import { emptyGrid, fillColumn, LiveTool, Probe, type State } from "../src/live_map.ts";
import { Machine } from "../src/machine.ts";
import type { Drawn } from "../src/mesh.ts";
import type { Cutter, Meta, Vec } from "../src/meta.ts";
import { close, endMill, floor } from "./support.ts";

const OVERLOOKED = 0.01;

/** Triangles of walls, each a corner and two sides, with their owners. */
function drawn(walls: { at: Vec; u: Vec; v: Vec; owner: number }[]): Drawn {
  const position: number[] = [];
  const owner: number[] = [];
  for (const { at, u, v, owner: of } of walls) {
    const corner = (a: number, b: number): Vec => [0, 1, 2].map((k) => at[k] + a * u[k] + b * v[k]) as Vec;
    for (const [a, b] of [[0, 0], [1, 0], [0, 1], [1, 0], [1, 1], [0, 1]]) {
      position.push(...corner(a, b));
      owner.push(of);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
  geometry.setIndex([...owner.keys()]);
  const tree = new MeshBVH(geometry);
  return { tree, position: new Float32Array(position), owner: new Float32Array(owner), there: () => true } as unknown as Drawn;
}

const meta = {
  overlooked_mm: OVERLOOKED, faces: [{ ignored: false }, { ignored: false }, { ignored: true }], kinematics: null, setups: [],
  tilt_limit_deg: null, tilt_deg: [0, 60], rotation_deg: [0, 90, 180, 270], setup: { z: [0, 0, 1], x: null },
} as unknown as Meta;

const ground = { at: [-50, -50, 0] as Vec, u: [100, 0, 0] as Vec, v: [0, 100, 0] as Vec, owner: 0 };
/** A wall across x, so far from the contact. */
const wall = (x: number, owner = 1) => ({ at: [x, -50, -1] as Vec, u: [0, 100, 0] as Vec, v: [0, 0, 60] as Vec, owner });

function state(cutter: Cutter, walls: Parameters<typeof drawn>[0], tilt: number, rotation: number, about: Meta = meta): State {
  return new Probe(drawn(walls), about, new Machine(about)).look(new LiveTool(cutter, about), floor, { tilt, rotation }, true).state;
}

test("on a floor a ball is free however it leans", () => {
  for (const tilt of [0, 20, 60]) for (const rotation of [0, 135]) assert.equal(state(endMill(4, 4, 40), [ground], tilt, rotation), "free");
});

test("a ball meets a wall at the very tilt at which its side reaches it", () => {
  const ball = endMill(4, 4, 40);
  // The upper end of the axis lies 36 beyond the centre, and the side 4 from the axis: x = 36 sin(t) + 4 cos(t).
  for (const tilt of [5, 15, 25, 35]) {
    const far = 36 * Math.sin((tilt * Math.PI) / 180) + 4 * Math.cos((tilt * Math.PI) / 180);
    assert.equal(state(ball, [ground, wall(far + 0.1)], tilt, 0), "free");
    assert.notEqual(state(ball, [ground, wall(far - 0.1)], tilt, 0), "free");
    assert.equal(state(ball, [ground, wall(far - 0.1)], tilt, 180), "free");
  }
});

test("depths up to what is overlooked are no gouge", () => {
  const ball = endMill(4, 4, 40);
  assert.equal(state(ball, [wall(4 - 0.5 * OVERLOOKED)], 0, 0), "free");
  assert.notEqual(state(ball, [wall(4 - 2 * OVERLOOKED)], 0, 0), "free");
  close(new LiveTool(ball, meta).spared, OVERLOOKED, 0);
});

test("what is near is rear gouging, what is far a collision, and other parts have their own names", () => {
  const long = endMill(2, 2, 40);
  assert.equal(state(long, [wall(1.5)], 0, 0), "rear_gouge");
  const high = { at: [-5, -5, 20] as Vec, u: [10, 0, 0] as Vec, v: [0, 10, 0] as Vec, owner: 1 };
  assert.equal(state(long, [high], 0, 0), "collision");
  assert.equal(state(long, [{ ...high, owner: 2 }], 0, 0), "free", "an ignored face");
  assert.equal(state(long, [{ ...high, owner: -1 }], 0, 0), "fixture");
  const held = endMill(2, 2, 15);
  held.outline.push({ part: "holder", points: [[0, 15], [9, 15], [9, 40], [0, 40]] });
  assert.equal(state(held, [high], 0, 0), "holder");
  const clamp = { ...high, at: [-5, -5, 8] as Vec, owner: -1 };
  assert.equal(state(held, [clamp], 0, 0), "fixture");
  assert.equal(state(held, [clamp, high], 0, 0), "holder", "a face of the part goes first");
});

test("the axis limit and the lack of contact come before what is met", () => {
  const limited = { ...meta, tilt_limit_deg: 20 } as Meta;
  assert.equal(state(endMill(2, 2, 40), [wall(1)], 30, 0, limited), "axis_limit");
  const few = endMill(2, 2, 40);
  few.modes[0].tilt_low_deg = 10;
  assert.equal(state(few, [wall(1)], 0, 0), "no_contact");
});

test("what curvature forbids is told only where something is met", () => {
  const bent = { ...floor, curvature: [1, 1] as [number, number] };
  const look = (walls: Parameters<typeof drawn>[0]): State =>
    new Probe(drawn(walls), meta, new Machine(meta)).look(new LiveTool(endMill(2, 2, 40), meta), bent, { tilt: 0, rotation: 0 }).state;
  assert.equal(look([ground]), "free");
  assert.equal(look([wall(1.5)]), "local_gouge");
});

test("a grid holds the state of each rotation and tilt", () => {
  const probe = new Probe(drawn([ground, wall(6)]), meta, new Machine(meta));
  const tool = new LiveTool(endMill(2, 2, 40), meta);
  const grid = emptyGrid(meta);
  assert.equal(grid.tilts.at(-1), 60);
  while (grid.done < grid.rotations.length) fillColumn(grid, probe, tool, floor);
  grid.rotations.forEach((rotation, column) =>
    grid.tilts.forEach((tilt, row) => {
      assert.equal(STATES[grid.state[column * grid.tilts.length + row]], probe.look(tool, floor, { tilt, rotation }).state);
    }),
  );
  assert.ok(new Set(grid.state).size > 1);
});
