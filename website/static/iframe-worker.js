// Browsers start no worker on a page opened from a file, so the search runs in a hidden frame there.
if (location.protocol === "file:") {
  // As between a page and its worker: a copy, and later.
  const send = (data, receiver) => {
    const copy = structuredClone(data);
    setTimeout(() => receiver().onmessage?.({ data: copy }));
  };
  window.Worker = class {
    constructor(address) {
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.append(this.frame);
      this.ready = new Promise((resolve, reject) => {
        const inside = this.frame.contentWindow;
        inside.postMessage = (data) => send(data, () => this);
        const script = inside.document.createElement("script");
        script.src = new URL(address, location.href).href;
        script.onload = () => resolve(inside);
        script.onerror = reject;
        inside.document.head.append(script);
      });
      this.ready.catch((error) => this.onerror?.(error));
    }

    postMessage(data) {
      this.ready.then((inside) => send(data, () => inside));
    }

    terminate() {
      this.frame.remove();
    }
  };
}
