// Where characters come from: files that are dropped anywhere on the page, or chosen by a button.

async function within(entry) {
  if (entry.isFile) return [await new Promise((resolve, reject) => { entry.file(resolve, reject); })];
  const reader = entry.createReader(), files = [];
  for (;;) { // a folder comes in pieces, and ends with an empty one
    const entries = await new Promise((resolve, reject) => { reader.readEntries(resolve, reject); });
    if (entries.length === 0) return files;
    for (const inner of entries) files.push(...await within(inner));
  }
}

// The files of a drop, and those in its folders. What was dropped must be asked for at once, before anything is awaited.
async function filesOf({ items }) {
  const dropped = [...items].filter(({ kind }) => kind === 'file').map((item) => item.webkitGetAsEntry?.() ?? item.getAsFile());
  return (await Promise.all(dropped.map((one) => (one instanceof File ? [one] : within(one))))).flat();
}

const hasFiles = (event) => event.dataTransfer?.types.includes('Files');

// `button` opens the choice of files with `input`; onFiles(files) gets what was dropped or chosen. While files hover over the page,
// the body has data-dropping.
export function takeFiles(button, input, onFiles) {
  let depth = 0; // of dragenter: every element on the way has its own
  const hover = (change) => {
    depth = change === 0 ? 0 : depth + change;
    document.body.toggleAttribute('data-dropping', depth > 0);
  };
  const on = (type, act) => document.addEventListener(type, (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    act(event);
  });
  on('dragenter', () => hover(1));
  on('dragover', ({ dataTransfer }) => { dataTransfer.dropEffect = 'copy'; });
  on('dragleave', () => hover(-1));
  on('drop', async ({ dataTransfer }) => {
    hover(0);
    onFiles(await filesOf(dataTransfer));
  });
  button.onclick = () => input.click();
  input.onchange = () => {
    const files = [...input.files];
    input.value = ''; // so that the same file can be chosen again
    if (files.length > 0) onFiles(files);
  };
}
