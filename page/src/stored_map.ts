// The certified free tilts that the page stores, rotation by rotation.

import type { Arrays, Numbers } from "./decode.ts";
import type { Meta } from "./meta.ts";

export interface Certified {
  /** For each rotation, free intervals of tilt, degrees, sorted. */
  free: [number, number][][];
  /** For each rotation, how much is neither free nor known to be forbidden, degrees. */
  undecided: number[];
}

export class StoredMaps {
  private readonly row: Numbers;
  private readonly start: Uint32Array;
  private readonly turns: number;

  constructor(
    private readonly meta: Meta,
    private readonly arrays: Arrays,
  ) {
    this.row = meta.maps ? arrays.get("maps.row").values : new Uint32Array();
    this.turns = meta.rotation_deg.length;
    this.start = new Uint32Array(this.row.length + 1);
    if (!meta.maps) return;
    const { rows, columns, values } = arrays.get("maps.count");
    for (let c = 0; c < columns; c++) for (let i = 0; i < rows; i++) this.start[i + 1] += values[c * rows + i];
    for (let i = 0; i < rows; i++) this.start[i + 1] += this.start[i];
  }

  /** The map of a sample and cutter; null where none is stored. */
  of(cutter: string, sample: number): Certified | null {
    if (this.meta.maps?.cutter !== cutter) return null;
    const at = this.row.indexOf(sample);
    if (at < 0) return null;
    const count = this.arrays.get("maps.count");
    const end = this.arrays.get("maps.end");
    const unsure = this.arrays.has("maps.undecided") ? this.arrays.get("maps.undecided") : null;
    let next = this.start[at];
    const free: [number, number][][] = [];
    const undecided: number[] = [];
    for (let k = 0; k < this.turns; k++) {
      const mine: [number, number][] = [];
      for (let i = 0; i < count.values[k * count.rows + at]; i++, next++) {
        mine.push([end.values[next] / 10, end.values[end.rows + next] / 10]);
      }
      free.push(mine);
      undecided.push(unsure ? unsure.values[k * unsure.rows + at] / 2 : 0);
    }
    return { free, undecided };
  }
}
