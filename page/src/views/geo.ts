// WGS84 position of a place near a map's anchor. Good to a decimeter within some kilometers, which
// is enough to read a position off a picture; the service computes poses exactly.
import type { Anchor } from "../api/types";

const RADIUS = 6_378_137;
const FLATNESS = 1 / 298.257223563;

/** Latitude and longitude, degrees, of a place in the map's frame, meters. */
export function toWgs84(anchor: Anchor, x: number, y: number): { lat: number; lon: number } {
  const yaw = (anchor.yaw_deg * Math.PI) / 180;
  const [dx, dy] = [x - anchor.position[0], y - anchor.position[1]];
  const east = dx * Math.cos(yaw) - dy * Math.sin(yaw);
  const north = dx * Math.sin(yaw) + dy * Math.cos(yaw);
  const lat = (anchor.lat * Math.PI) / 180;
  const squared = FLATNESS * (2 - FLATNESS);
  const root = Math.sqrt(1 - squared * Math.sin(lat) ** 2);
  const meridian = (RADIUS * (1 - squared)) / root ** 3;
  const parallel = (RADIUS / root) * Math.cos(lat);
  return {
    lat: anchor.lat + (north / (meridian + anchor.height)) * (180 / Math.PI),
    lon: anchor.lon + (east / (parallel + anchor.height * Math.cos(lat))) * (180 / Math.PI),
  };
}
