import assert from "node:assert/strict";
import { test } from "node:test";
import { degrees, figure, percent } from "../src/dom.ts";

test("a share is 100 % only as the whole, and 0 % only as nothing", () => {
  const written: [number, string][] = [
    [0, "0 %"], [-0.1, "0 %"], [1, "100 %"], [1.2, "100 %"], [0.5, "50 %"], [0.123, "12.3 %"], [0.9996, ">99.9 %"],
    [1 - 1e-12, ">99.9 %"], [1e-5, "<0.1 %"], [0.0005001, "0.1 %"], [0.999, "99.9 %"],
  ];
  for (const [share, text] of written) assert.equal(percent(share), text);
});

test("a number is written without an exponent, and what rounding leaves is nothing", () => {
  const written: [number, string][] = [
    [0.0000123456, "0.0000123"], [1234567.8, "1234568"], [12.3456, "12.3"], [-2.8e-17, "0"], [NaN, "unknown"], [100, "100"],
  ];
  for (const [value, text] of written) assert.equal(figure(value), text);
});

test("a whole turn is none", () => {
  assert.deepEqual([359.97, -0.01, 12.34, 0].map(degrees), ["0", "0", "12.3", "0"]);
});
