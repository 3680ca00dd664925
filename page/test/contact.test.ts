import assert from "node:assert/strict";
import { test } from "node:test";
import { gougeBounds, gouges, modeAt, place, runs } from "../src/contact.ts";
import { dot, minus, mixed, norm, plus, RAD, scaled } from "../src/vectors.ts";
import { away, between, close, direction, endMill, floor, numbers, sampleAt } from "./support.ts";

test("a placed end mill touches its contact with the circle of its corner", () => {
  const random = numbers(1);
  for (let k = 0; k < 200; k++) {
    const radius = between(random, 1, 8);
    const corner = radius * random();
    const sample = sampleAt(random);
    const posture = { tilt: between(random, 1, 89), rotation: between(random, 0, 360) };
    const { tip, axis } = place(endMill(radius, corner, 40), sample, posture);
    close(dot(axis, sample.normal), Math.cos(posture.tilt * RAD), 1e-12);
    // The centre of the corner lies on its circle about the axis, and the contact a corner radius from it along the normal.
    const centre = mixed(sample.point, 1, sample.normal, corner);
    const from = minus(centre, tip);
    close(dot(from, axis), corner, 1e-9, "height");
    close(away(from, axis), radius - corner, 1e-9, "offset");
    // Of that circle it is the lowest point over the surface.
    close(dot(minus(from, scaled(axis, corner)), sample.normal), -(radius - corner) * Math.sin(posture.tilt * RAD), 1e-9);
  }
});

test("a ball stands on its centre whatever the posture", () => {
  const random = numbers(2);
  const [ball, sample] = [endMill(3, 3, 40), sampleAt(random)];
  for (let k = 0; k < 50; k++) {
    const { tip, axis } = place(ball, sample, { tilt: between(random, 0, 180), rotation: between(random, 0, 360) });
    close(norm(minus(mixed(tip, 1, axis, 3), mixed(sample.point, 1, sample.normal, 3))), 0, 1e-9);
  }
});

test("a ball gouges where the surface is rounder than it", () => {
  const random = numbers(3);
  for (const [curvature, expected] of [[0.2, false], [0.3, false], [0.4, true]] as const) {
    const sample = sampleAt(random, [curvature, 0]);
    assert.equal(gouges(endMill(3, 3, 40), sample, { tilt: 30, rotation: 70 }), expected);
  }
});

test("a flat end gouges up to the tilt at which its ellipse is as flat as the groove", () => {
  // Across a groove of radius 20, a disk of radius 5 looks like an ellipse whose end has the radius 5 / sin(tilt).
  const [low, high] = gougeBounds([1 / 20, 0], Math.PI / 2, 5, 0)!;
  close(low, Math.asin(5 / 20), 1e-12);
  close(high, Math.PI - Math.asin(5 / 20), 1e-12);
  assert.equal(gougeBounds([1 / 4, 0], Math.PI / 2, 5, 0), null);
  assert.deepEqual(gougeBounds([-0.1, -0.2], 0.3, 5, 0), [0, Math.PI]);
});

test("a corner gouges just where points of the surface near the contact lie in its ring", () => {
  const random = numbers(7);
  const decided = { yes: 0, no: 0 };
  for (let k = 0; k < 400; k++) {
    const corner = between(random, 0.5, 3);
    const tool = endMill(corner + between(random, 0.5, 5), corner, 40);
    const least = between(random, -0.3, 0.25);
    const curvature: [number, number] = [between(random, least, 0.3), least];
    const sample = { ...floor, curvature };
    const posture = { tilt: between(random, 2, 88), rotation: between(random, 0, 360) };
    const { tip, axis } = place(tool, sample, posture);
    const centre = plus(tip, axis, corner);
    // The least distance from the ring beyond its radius, in squares of the distance from the contact.
    let least2 = Infinity;
    for (let i = 0; i < 360; i++) {
      const [x, y] = [1e-3 * Math.cos(i * RAD), 1e-3 * Math.sin(i * RAD)];
      const q = minus([x, y, 0.5 * (curvature[0] * x * x + curvature[1] * y * y)], centre);
      least2 = Math.min(least2, (Math.hypot(away(q, axis) - (tool.radius - corner), dot(q, axis)) - corner) / 1e-6);
    }
    if (Math.abs(least2) < 5e-3) continue;
    assert.equal(gouges(tool, sample, posture), least2 < 0, `${least2} ${JSON.stringify({ curvature, posture, corner })}`);
    decided[least2 < 0 ? "yes" : "no"]++;
  }
  assert.ok(decided.yes > 50 && decided.no > 50, JSON.stringify(decided));
});

test("bounds of a corner come to those of a flat end as the corner vanishes", () => {
  const random = numbers(4);
  for (let k = 0; k < 100; k++) {
    const least = between(random, -0.1, 0.1);
    const curvatures: [number, number] = [between(random, least, 0.15), least];
    const rotation = between(random, 0, 2 * Math.PI);
    const flat = gougeBounds(curvatures, rotation, 5, 0);
    const small = gougeBounds(curvatures, rotation, 5, 1e-9);
    assert.equal(flat === null, small === null);
    if (flat && small) flat.forEach((bound, i) => close(bound, small[i], 1e-4));
  }
});

test("runs end at tilts that are held", () => {
  const held = [true, true, false, false, true, false, true];
  assert.deepEqual(runs([0, 1, 2, 3, 4, 5, 6], (_, row) => held[row]), [[0, 1], [4, 4], [6, 6]]);
  assert.deepEqual(runs([0, 1], () => false), []);
});

test("a tool touches in the mode of its tilt alone", () => {
  const lens = endMill(5, 1, 30);
  lens.modes = [{ offset: 0, radius: 20, height: 20, tilt_low_deg: 0, tilt_high_deg: 10 }, { offset: 4, radius: 1, height: 1, tilt_low_deg: 10, tilt_high_deg: 90 }];
  assert.equal(modeAt(lens, 5), lens.modes[0]);
  assert.equal(modeAt(lens, 10), lens.modes[0]);
  assert.equal(modeAt(lens, 40), lens.modes[1]);
  assert.equal(modeAt(lens, 91), null);
});
