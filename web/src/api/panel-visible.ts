import { createContext, useContext } from "react";

/** Whether the panel around is on screen; hidden panels neither ask, stream nor draw. */
export const PanelVisible = createContext(true);

export const usePanelVisible = (): boolean => useContext(PanelVisible);
