// Made by `python page/codes.py` from the tables of the program: change those, not this.

/** States of a posture in a map: what can forbid it stands in the order in which it is told. */
export const STATES = ["free", "axis_limit", "no_contact", "local_gouge", "rear_gouge", "collision", "neck", "shank", "holder", "fixture", "undecided", "tolerance", "buried"] as const;

/** What a tool meets, from its upper end down: a fixture can be moved, as a holder can be changed. */
export const OUTERMOST = ["holder", "fixture", "shank", "neck", "collision", "rear_gouge", "local_gouge"] as const;

/** Sines of less are none. */
export const PARALLEL = 1e-06;

/** By so much an axis may be beyond a limit and still be on it, rad. */
export const ON_LIMIT = 1e-09;

/** Nearer to the first rotary axis than this, degrees, the machine turns fast. */
export const SINGULAR = 2.0;

/** What rounding leaves of nothing is below this. */
export const ROUNDING = 1e-09;

/** How a share is written that would be rounded to none. */
export const HARDLY_ANY = "<0.1 %";

/** How a share is written that would be rounded to the whole. */
export const ALL_BUT = ">99.9 %";
