// Runs all tests in one process, so that they share a browser and do not compete for the processors.
import "./picture.mjs";
import "./projection.mjs";
import "./keys.mjs";
import "./buttons.mjs";
import "./client.mjs";
import "./command_line.mjs";
import "./readings.mjs";
import "./slider.mjs";
import "./picker.mjs";
import "./loading.mjs";
import "./export.mjs";
import "./colors.mjs";
import "./connection.mjs";
import "./links.mjs";
import "./pointer.mjs";
import "./pointing.mjs";
import "./frame_pointing.mjs";
import "./matrix.mjs";
import "./phone.mjs";
import "./first_visit.mjs";
import "./performance.mjs";
import "./accessibility.mjs";
import "./axe.mjs";
import "./without_webgl.mjs";
import "./firefox.mjs";
import { runAll } from "./support/suite.mjs";

runAll("the page in a browser");
