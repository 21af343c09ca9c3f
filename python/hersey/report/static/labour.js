// A worker that answers the newest question. A worker that has shown a part of its answer, or takes long, is ended
// for the next question. It runs the text of the core and of the questions on the module that the page compiled.

function labour(module, heard) {
  const PATIENCE = 400;
  const text = `${physics}\n${answers}\n(${inside})();`;
  const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  let worker = null, running = null, waiting = null, count = 0;

  function inside() {
    let ready = null;
    self.onmessage = async ({ data: message }) => {
      if (message.module) { ready = physics(message.module).then(answers); return; }
      const { number, task, job } = message;
      try {
        for (const part of (await ready).tasks[task](job)) self.postMessage({ number, part });
        self.postMessage({ number, done: true });
      } catch (error) {
        self.postMessage({ number, failure: error.message, done: true });
      }
    };
  }
  function start() {
    worker = new Worker(address);
    worker.postMessage({ module });
    worker.onmessage = ({ data: message }) => {
      if (message.number !== running?.number) return;
      running.heard = true;
      const { about } = running;
      if (message.done) running = null;
      if (!waiting) heard(message, about);
      next();
    };
    worker.onerror = (event) => {
      event.preventDefault();
      const { about } = running ?? {};
      running = null;
      heard({ failure: event.message || "the browser does not allow workers", done: true }, about);
    };
  }
  function next() {
    if (!waiting) return;
    if (running && (running.heard || performance.now() - running.since > PATIENCE)) {
      worker.terminate();
      worker = null;
      running = null;
    }
    if (running) return;
    const { about } = waiting;
    try {
      if (!worker) start();
    } catch (error) {
      waiting = null;
      heard({ failure: `the browser does not allow workers (${error.message})`, done: true }, about);
      return;
    }
    running = { ...waiting, since: performance.now() };
    waiting = null;
    worker.postMessage({ number: running.number, task: running.task, job: running.job });
  }
  return {
    ask(task, job, about) {
      waiting = { number: count += 1, task, job, about };
      next();
    },
    // What is asked no longer counts.
    forget() {
      waiting = null;
      if (!running) return;
      worker.terminate();
      worker = null;
      running = null;
    },
  };
}
