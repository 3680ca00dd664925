// Files that import each other in a circle, if only for their types.
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

/** What each file of a folder imports from beside it. */
export function importsOf(folder) {
  const names = readdirSync(folder).filter((name) => name.endsWith(".ts"));
  const found = (name) => [...readFileSync(join(folder, name), "utf8").matchAll(/\bfrom "\.\/([\w.]+)"/g)].map(([, path]) => path);
  return new Map(names.map((name) => [name, found(name).map((path) => (path.endsWith(".ts") ? path : `${path}.ts`))]));
}

/** Names that lead back to themselves: those that are left when each whose imports are all gone is taken away, again and again. */
export function circle(imports) {
  const left = new Map(imports);
  for (let before = -1; before !== left.size; ) {
    before = left.size;
    for (const [name, of] of left) if (!of.some((each) => left.has(each))) left.delete(name);
  }
  // What only leads to a circle is not in it.
  for (let before = -1; before !== left.size; ) {
    before = left.size;
    const wanted = new Set([...left.values()].flat());
    for (const name of left.keys()) if (!wanted.has(name)) left.delete(name);
  }
  return [...left.keys()].sort();
}
