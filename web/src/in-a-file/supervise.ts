import { carryOut, type Done } from "./carry-out";
import { valueWords } from "./command-words";
import type { FileBoard } from "./file-board";

const differs = (one: unknown, other: unknown) => JSON.stringify(one) !== JSON.stringify(other);

/** Take the request of the supervisor that is not carried out yet, and carry out the changes. */
export function obey(board: FileBoard): Done[] {
  const { supervisor } = board.document;
  const { p, w } = board.arrays;
  if (!supervisor || !(w.view[supervisor.place] > 0)) return [];
  const request = w.view[supervisor.place];
  w.view[supervisor.place] = 0;
  if (board.trip) return [];
  return supervisor.requests[request - 1].flatMap(({ act, numbers }): Done[] => {
    if ("switch" in act) return Object.values(board.driving).includes(act.switch) ? [] : [carryOut(board, act)];
    if ("make_safe" in act) {
      board.makeSafe(act.make_safe);
      return [{ kind: "make_safe", text: `safe outputs: ${act.make_safe}`, old: null, now: board.trip }];
    }
    const left = Object.entries(act.set).filter(([path, value]) => differs(board.supervised[path], value));
    if (left.length === 0) return [];
    const old = Object.fromEntries(left.map(([path]) => [path, board.supervised[path]]));
    for (const [i, place] of supervisor.places.entries()) p.view[Number(place)] = (numbers as Float64Array)[i];
    board.supervised = { ...board.supervised, ...act.set };
    const now = Object.fromEntries(left);
    return [{ kind: "set", text: `set ${valueWords(now)}`, old, now }];
  });
}
