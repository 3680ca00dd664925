// No file of the page imports another in a circle, and a circle is seen where there is one.

import assert from "node:assert/strict";
import { test } from "node:test";
import { circle, importsOf } from "../circles.mjs";

test("files that lead to a circle, or from it, are not in it", () => {
  const imports = new Map([["main", ["a"]], ["a", ["b", "leaf"]], ["b", ["c"]], ["c", ["a", "leaf"]], ["leaf", []]]);
  assert.deepEqual(circle(imports), ["a", "b", "c"]);
  imports.set("c", ["leaf"]);
  assert.deepEqual(circle(imports), []);
});

test("the files of the page import each other in no circle, and views are not known to the state", () => {
  const imports = importsOf("src");
  assert.ok(imports.get("main.ts")!.includes("state.ts"));
  assert.deepEqual(circle(imports), []);
  const known = new Set(["state.ts"]);
  for (const name of known) for (const each of imports.get(name) ?? []) known.add(each);
  for (const view of ["picture.ts", "stage.ts", "part.ts", "dom.ts", "posture_map.ts", "views.ts"]) assert.ok(!known.has(view), view);
});
