// How the page asks the studio: with the token of its address, and with the refusals as errors.

export type Value = string | number | boolean | Value[];
export type Step = [string, Value][];

export interface Recipe {
  tab: string;
  revision: number;
  file: string | null;
  name: string | null;
  steps: Step[];
  text: string;
  undo: boolean;
  redo: boolean;
}

/** A refusal with its code, as the terminal would print it. */
export class Refusal extends Error {
  constructor(
    message: string,
    readonly code: string,
    readonly step: number | null = null,
    readonly key: string | null = null,
  ) {
    super(message);
  }
}

const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

export const withToken = (path: string) =>
  `${path}${path.includes("?") ? "&" : "?"}token=${encodeURIComponent(token)}`;

async function send(method: string, path: string, body?: unknown, signal?: AbortSignal) {
  const headers: Record<string, string> = { "x-kerfold-token": token };
  let sent: BodyInit | undefined;
  if (body instanceof Blob) sent = body;
  else if (body !== undefined) {
    headers["content-type"] = "application/json";
    sent = JSON.stringify(body);
  }
  let answer: Response;
  try {
    answer = await fetch(path, { method, headers, body: sent, signal });
  } catch (error) {
    if (signal?.aborted) throw new Refusal("stopped", "E907");
    throw new Refusal("the studio does not answer; is it still running?", "", null, null);
  }
  if (answer.ok) return answer;
  const told = await answer.json().catch(() => ({ message: answer.statusText, code: "" }));
  throw new Refusal(told.message, told.code, told.step, told.key);
}

export const getJson = async <T>(path: string, signal?: AbortSignal): Promise<T> =>
  (await send("GET", path, undefined, signal)).json();
export const getText = async (path: string, signal?: AbortSignal) =>
  (await send("GET", path, undefined, signal)).text();
export const post = async <T>(path: string, body: unknown = {}, method = "POST", signal?: AbortSignal): Promise<T> =>
  (await send(method, path, body, signal)).json();
export const getArrays = async (path: string, signal?: AbortSignal) =>
  decode(await (await send("GET", path, undefined, signal)).arrayBuffer());
export const postArrays = async (path: string, body: unknown, signal?: AbortSignal) =>
  decode(await (await send("POST", path, body, signal)).arrayBuffer());

/** Arrays with what is told about them; the form stands in openapi.json. */
export interface Arrays {
  told: Record<string, any>;
  f32(name: string): Float32Array;
  u32(name: string): Uint32Array;
}

function decode(buffer: ArrayBuffer): Arrays {
  const view = new DataView(buffer);
  const length = view.getUint32(4, true);
  const told = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  const place = (name: string) => told.arrays[name] as { at: number; count: number };
  return {
    told,
    f32: (name) => new Float32Array(buffer, 8 + length + place(name).at, place(name).count),
    u32: (name) => new Uint32Array(buffer, 8 + length + place(name).at, place(name).count),
  };
}

/** Does one thing at a time and forgets all but the newest that waits: a slider in motion. */
export function newest(task: () => Promise<void>): () => Promise<void> {
  let running: Promise<void> | null = null;
  let again = false;
  return async () => {
    if (running) {
      again = true;
      return running;
    }
    running = (async () => {
      do {
        again = false;
        await task();
      } while (again);
      running = null;
    })();
    return running;
  };
}
