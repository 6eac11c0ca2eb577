/** Tables of a scene as TOML text. */

type Field = number | string | readonly Field[] | { [name: string]: Field };

/** `[name]` and its fields; without fields, an empty table, which removes that of the scene. */
export function table(name: string, fields: Record<string, Field> = {}): string {
  const lines = Object.entries(fields).map(([field, value]) => `${field} = ${toml(value)}`);
  return [`[${name}]`, ...lines, ""].join("\n");
}

/** Single fields of a table as dotted keys, which must precede all tables; `{}` removes the field of the scene. */
export function fields(name: string, values: Record<string, Field>): string {
  return Object.entries(values)
    .map(([field, value]) => `${name}.${field} = ${toml(value)}\n`)
    .join("");
}

function toml(value: Field): string {
  if (typeof value === "number") return String(value);
  if (typeof value === "string") return JSON.stringify(value);
  if (value instanceof Array) return `[${value.map(toml).join(", ")}]`;
  const fields = Object.entries(value).map(([name, field]) => `${name} = ${toml(field)}`);
  return `{ ${fields.join(", ")} }`;
}
