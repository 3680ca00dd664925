import assert from "node:assert/strict";
import { test } from "node:test";
import { Machine, turnsTo } from "../src/machine.ts";
import type { Kinematics, Meta, Vec } from "../src/meta.ts";
import { cross, norm, RAD } from "../src/vectors.ts";
import { between, close, direction, numbers, rotated } from "./support.ts";

const FREE: [null, null] = [null, null];
const trunnion: Kinematics = { direction: [[0, 0, 1], [1, 0, 0]], limit_deg: [FREE, [-30, 110]], tool: [0, 0, 1] };

function machine(kinematics: Kinematics | null, limit: number | null = null): Machine {
  return new Machine({ kinematics, tilt_limit_deg: limit, tilt_deg: [0, 90], setups: [], setup: { z: [0, 0, 1], x: null } } as unknown as Meta);
}

/** The tool axis at angles, degrees: the tool turned about the last axis first. */
const axisAt = ({ direction: d, tool }: Kinematics, angles: number[]): Vec =>
  angles.reduceRight((axis, angle, k) => rotated(axis, d[k], angle * RAD), tool);

test("positions hold the axis that they are for, the ones within the limits first", () => {
  const random = numbers(11);
  for (let k = 0; k < 300; k++) {
    const axes: [Vec, Vec] = [direction(random), direction(random)];
    if (norm(cross(...axes)) < 0.2) continue;
    const kinematics: Kinematics = { direction: axes, limit_deg: [[-120, 120], FREE], tool: direction(random) };
    const axis = axisAt(kinematics, [between(random, -180, 180), between(random, -180, 180)]);
    const found = machine(kinematics).positions(axis);
    assert.ok(found.length === 1 || found.length === 2);
    for (const { angles, within } of found) {
      axisAt(kinematics, angles).forEach((x, i) => close(x, axis[i], 1e-7));
      // The turn within the limits is taken if there is one.
      assert.equal(within[0], Math.abs(angles[0]) <= 120 + 1e-6);
    }
    const good = found.map(({ within }) => within.every(Boolean));
    assert.deepEqual(good, [...good].sort((a, b) => Number(b) - Number(a)));
  }
});

test("a trunnion holds what its second axis reaches", () => {
  const held = machine(trunnion);
  for (let tilt = 0; tilt <= 180; tilt += 2.5) {
    for (let around = 0; around < 360; around += 15) {
      const axis: Vec = [Math.sin(tilt * RAD) * Math.cos(around * RAD), Math.sin(tilt * RAD) * Math.sin(around * RAD), Math.cos(tilt * RAD)];
      if (tilt !== 110) assert.equal(held.holds(axis), tilt < 110, `${tilt} ${around}`);
    }
  }
  const [first] = held.positions([0, 0, 1]);
  assert.equal(first.free, true);
});

test("a plain limit is a cone about the setup axis", () => {
  const held = machine(null, 40);
  assert.ok(held.holds([Math.sin(40 * RAD), 0, Math.cos(40 * RAD)]));
  assert.ok(!held.holds([Math.sin(40.01 * RAD), 0, Math.cos(40.01 * RAD)]));
});

test("one axis alone turns the tool to its own circle", () => {
  const one: Kinematics = { direction: [[1, 0, 0]], limit_deg: [[-90, 90]], tool: [0, 0, 1] };
  assert.ok(turnsTo(one, axisAt(one, [50])));
  assert.ok(!turnsTo(one, axisAt(one, [120])));
  assert.ok(!turnsTo(one, [Math.sin(0.01), 0, Math.cos(0.01)]));
  const none: Kinematics = { direction: [], limit_deg: [], tool: [0, 0, 1] };
  assert.ok(turnsTo(none, [0, 0, 1]));
  assert.ok(!turnsTo(none, [0, 0, -1]));
});
