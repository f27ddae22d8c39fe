/** The path of the server, such as "/bench/"; the root where there is no page. */
const pathHere = () => (globalThis.document ? new URL("./", document.baseURI).pathname : "/");

/**
 * The name under which the storage of the browser keeps something for the page of this server: servers below several
 * paths of a host share that storage.
 */
export const storageName = (name: string, path = pathHere()): string => (path === "/" ? name : `${name} ${path}`);
