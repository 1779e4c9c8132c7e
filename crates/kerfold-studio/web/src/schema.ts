// What steps take, from the studio: forms need no list of their own.

import type { Step, Value } from "./api";

export interface Key {
  name: string;
  help: string;
  kind: string;
  unit: string | null;
  valueName: string;
  choices: { word: string; help: string }[];
  examples: string[];
  default?: Value;
  range?: [number, number];
  isRequired: boolean;
  isList: boolean;
}

export interface Kind {
  title: string;
  verb: string;
  value: string | null;
  group: string;
  keys: Key[];
}

export function kindsOf(schema: any): Kind[] {
  return schema.properties.step.items.anyOf.map((step: any): Kind => {
    const about = step["x-kerfold"];
    return {
      title: step.title,
      verb: about.verb,
      value: about.value,
      group: about.group,
      keys: about.order.map((name: string): Key => {
        const key = step.properties[name];
        const more = key["x-kerfold"];
        return {
          name,
          help: key.description,
          kind: more.kind,
          unit: more.unit,
          valueName: more.value_name,
          choices: more.choices,
          examples: key.examples ?? [],
          default: key.default,
          range: key.minimum === undefined ? undefined : [key.minimum, key.maximum],
          isRequired: step.required.includes(name),
          isList: more.list,
        };
      }),
    };
  });
}

export const valueOf = (step: Step, key: string): Value | undefined => step.find(([name]) => name === key)?.[1];

export function kindOf(kinds: Kind[], step: Step): Kind | undefined {
  const [verb, value] = step[0] ?? ["", ""];
  return kinds.find((kind) => kind.verb === verb && (kind.value === null || kind.value === value));
}

export function withKey(step: Step, key: string, value: Value | undefined): Step {
  const rest = step.filter(([name]) => name !== key);
  if (value === undefined) return rest;
  const at = step.findIndex(([name]) => name === key);
  const next = [...step];
  if (at < 0) next.push([key, value]);
  else next[at] = [key, value];
  return next;
}

/** A key as people read it. */
export const labelOf = (name: string) => name.replaceAll("_", " ");
