// Files that are dropped or opened, with their places in their folders.

export interface Dropped { file: File; path: string }

const MOST_IN_A_FOLDER = 8; // of numbered pictures: scans hold thousands, and one photo is used

/** What a drop holds, folders with all that is inside. */
export async function filesOfDrop(transfer: DataTransfer | null): Promise<Dropped[]> {
  const entries = [...(transfer?.items ?? [])].map((item) => item.webkitGetAsEntry?.()).filter((one): one is FileSystemEntry => !!one);
  if (entries.length) return (await Promise.all(entries.map(filesOfEntry))).flat();
  return [...(transfer?.files ?? [])].map((file) => ({ file, path: file.name }));
}

/** Files of an input element; those of a folder bring their paths. */
export const filesOfInput = (input: HTMLInputElement): Dropped[] => [...(input.files ?? [])].map((file) => ({ file, path: file.webkitRelativePath || file.name }));

/** The first pictures of each folder, and everything that is no numbered picture. */
export function thinned(dropped: Dropped[]): Dropped[] {
  const seen = new Map<string, number>(), isNumbered = ({ path }: Dropped) => /[/\\][\d._-]+\.[a-z]+$/i.test(path);
  const sorted = [...dropped].sort((a, b) => a.path.localeCompare(b.path, "en", { numeric: true }));
  return sorted.filter((one) => {
    if (!isNumbered(one)) return true;
    const folder = one.path.replace(/[^/\\]+$/, ""), count = (seen.get(folder) ?? 0) + 1;
    seen.set(folder, count);
    return count <= MOST_IN_A_FOLDER;
  });
}

/** The form that the server takes. */
export function uploadForm(dropped: Dropped[], radar: string): FormData {
  const form = new FormData(), few = thinned(dropped);
  for (const { file } of few) form.append("files", file, file.name);
  form.append("paths", JSON.stringify(few.map(({ path }) => path)));
  form.append("radar", radar);
  return form;
}

async function filesOfEntry(entry: FileSystemEntry): Promise<Dropped[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    return [{ file, path: entry.fullPath.replace(/^\//, "") }];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader(), inside: FileSystemEntry[] = [];
  for (;;) { const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject)); if (!some.length) break; inside.push(...some); }
  return (await Promise.all(inside.map(filesOfEntry))).flat();
}
