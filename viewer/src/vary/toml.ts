/** Tables of scenes as text, from what the sliders say. */

type Field = number | string | Field[] | { [name: string]: Field };

/** `[name]` and its fields; with none, the empty table that takes away the scene's own. */
export function table(name: string, fields: Record<string, Field> = {}): string {
  const lines = Object.entries(fields).map(([field, value]) => `${field} = ${written(value)}`);
  return [`[${name}]`, ...lines, ""].join("\n");
}

/** Fields of a table of which the others stay, to stand before any `[name]`; an empty one takes the scene's own away. */
export function fields(name: string, values: Record<string, Field>): string {
  return Object.entries(values)
    .map(([field, value]) => `${name}.${field} = ${written(value)}\n`)
    .join("");
}

function written(value: Field): string {
  if (typeof value === "number") return String(value);
  if (typeof value === "string") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(written).join(", ")}]`;
  const fields = Object.entries(value).map(([name, field]) => `${name} = ${written(field)}`);
  return `{ ${fields.join(", ")} }`;
}
