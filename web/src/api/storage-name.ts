/** The path of the server, such as "/bench/"; servers below several paths of a host share the storage of a browser. */
const PATH = new URL("./", document.baseURI).pathname;

/** The name under which the storage of the browser keeps something for the page of this server. */
export const storageName = (name: string, path = PATH): string => (path === "/" ? name : `${name} ${path}`);
