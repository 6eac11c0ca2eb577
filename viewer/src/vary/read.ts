/** Reads one table of a scene that the core has accepted. */

export type Value = string | number | boolean | Value[] | { [name: string]: Value };

/** The fields of a table of a TOML text, with those of tables in it; null if it has no such table. */
export function tableOf(text: string, name: string): Record<string, Value> | null {
  return ((new Reader(text).document()[name] as Record<string, Value> | undefined) ?? null) as Record<
    string,
    Value
  > | null;
}

class Reader {
  private at = 0;

  constructor(private readonly text: string) {}

  document(): Record<string, Value> {
    const root: Record<string, Value> = {};
    let table = root;
    while (this.skip(true)) {
      if (this.text[this.at] === "[") {
        this.at += this.text.startsWith("[[", this.at) ? 2 : 1;
        table = into(root, this.key());
        this.skip();
        while (this.text[this.at] === "]") this.at += 1;
      } else {
        this.pair(table);
      }
    }
    return root;
  }

  private pair(table: Record<string, Value>): void {
    const path = this.key();
    this.skip();
    this.at += 1; // the equals sign
    into(table, path.slice(0, -1))[path.at(-1)!] = this.value();
  }

  private key(): string[] {
    const path: string[] = [];
    do {
      this.skip();
      const quote = this.text[this.at];
      path.push(quote === '"' || quote === "'" ? this.quoted(quote) : this.match(/[\w-]+/uy));
      this.skip();
    } while (this.text[this.at] === "." && (this.at += 1));
    return path;
  }

  private value(): Value {
    this.skip(true);
    const first = this.text[this.at]!;
    if (first === '"' || first === "'") return this.quoted(first);
    if (first === "[") return this.list();
    if (first === "{") return this.inline();
    const word = this.match(/[^\s,\]}#]+/uy);
    if (word === "true" || word === "false") return word === "true";
    const number = Number(word.replaceAll("_", ""));
    return Number.isNaN(number) ? word : number;
  }

  private list(): Value[] {
    const found: Value[] = [];
    this.at += 1;
    while (this.skip(true) && this.text[this.at] !== "]") {
      found.push(this.value());
      this.skip(true);
      if (this.text[this.at] === ",") this.at += 1;
    }
    this.at += 1;
    return found;
  }

  private inline(): Record<string, Value> {
    const table: Record<string, Value> = {};
    this.at += 1;
    while (this.skip(true) && this.text[this.at] !== "}") {
      this.pair(table);
      this.skip(true);
      if (this.text[this.at] === ",") this.at += 1;
    }
    this.at += 1;
    return table;
  }

  private quoted(quote: string): string {
    const many = quote.repeat(3);
    const end = this.text.startsWith(many, this.at) ? many : quote;
    const from = this.at + end.length;
    let to = from;
    while (to < this.text.length && !this.text.startsWith(end, to))
      to += quote === '"' && this.text[to] === "\\" ? 2 : 1;
    this.at = to + end.length;
    return this.text.slice(from, to);
  }

  /** Skips spaces and, with lines, comments and line ends; returns whether there is more. */
  private skip(lines = false): boolean {
    this.match(lines ? /(?:\s|#[^\n]*)*/uy : /[ \t]*/uy);
    return this.at < this.text.length;
  }

  private match(pattern: RegExp): string {
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text)?.[0] ?? "";
    // Progress even in a text that is not TOML.
    this.at += found.length || Number(!pattern.source.endsWith("*"));
    return found;
  }
}

function into(table: Record<string, Value>, path: readonly string[]): Record<string, Value> {
  return path.reduce((inner, name) => {
    const next = inner[name];
    if (typeof next === "object" && !Array.isArray(next)) return next;
    return (inner[name] = {}) as Record<string, Value>;
  }, table);
}
